#pragma once
#include <ImfFrameBuffer.h>
#include <ImfMultiPartInputFile.h>

#include <exception>
#include <memory>
#include <new>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/exr_layout.h"
#include "core/io/exr_reader.h"

namespace aftershade::io {

/// An open file. The order of the members is the order in which they need each other.
struct ExrReader::Handles {
  FileInfo info;
  ReadLimits limits;
  FileBytes bytes;
  ExrLayout layout;
  bool standard_headers = false;  ///< else OpenEXR alone reads it

  /// Are parts of this compression decoded and encoded here (exr_codec.h), not by OpenEXR?
  bool uses_codecs(int compression) const;
  /// The file as OpenEXR opens it, which parses the headers once more: done when it is first needed.
  Imf::MultiPartInputFile& openexr() const;

  Handles(const std::string& path, const ReadLimits& read_limits)
      : limits(read_limits), bytes(path), stream(bytes, path) {
    info.path = path;
  }

 private:
  mutable SourceStream stream;
  mutable std::unique_ptr<Imf::MultiPartInputFile> file;
};

/// "part beauty of shot.0001.exr", or the path alone when the file has one part without a name.
std::string part_text(const FileInfo& info, int part);

/// What OpenEXR says, without the file's name in quotes: the message around it names the file.
std::string reason(const std::exception& error);

/// Runs `work`; whatever OpenEXR throws becomes an Error that starts with `subject` (a file, or a part of one).
template <class Work>
auto guarded(const std::string& subject, Work&& work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::memory, cat(subject, " needs more memory than there is"));
  } catch (const std::exception& error) {
    throw Error(ErrorCode::data, cat(subject, " is damaged: ", reason(error)), "render or copy it again");
  }
}

/// A frame buffer slice: `data` points to the pixel at the upper left corner of `window`. OpenEXR wants the address of
/// absolute pixel (0, 0), which may lie outside the memory: integer arithmetic, as pointers may not go there.
Imf::Slice slice(Imf::PixelType type, void* data, Window window, size_t x_stride, size_t y_stride);

/// Lets OpenEXR decode rows [first, last] of a part into the frame buffer, whose slices cover the data window's
/// columns; tiled parts are decoded whole. Throws what OpenEXR throws.
void decode(const ExrReader::Handles& handles, int part, const Imf::FrameBuffer& target, int first, int last);

}  // namespace aftershade::io
