#pragma once
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/io/exr_reader.h"

namespace aftershade::io {

/// A channel whose pixels differ from the source file's, or that is new.
struct ChannelWrite {
  int part = 0;
  std::string channel;
  ConstPlaneView pixels;
  Window window;        ///< absolute pixels that `pixels` covers; the rest of the part's data window keeps its values
  bool is_new = false;  ///< new channels are half
};

/// Throws Error(usage) unless `name` is "keep" or a compression: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa,
/// dwab.
void check_compression(const std::string& name);

enum class DataWindowPolicy { keep, grow };

struct WriteOptions {
  std::optional<std::string> compression{};  ///< for changed parts; "keep" keeps a lossy one; default: see write_exr
  DataWindowPolicy data_window =
      DataWindowPolicy::keep;      ///< grow: changed parts cover the union of their writes' windows
  bool only_new_channels = false;  ///< --ao-only: a single-part file with the new channels alone, whatever `source` has
  bool recode = false;             ///< every part is decoded and encoded again, even when nothing of it has changed
  bool fsync = true;               ///< the file has reached the disk before it gets its name
};

/// Decoded parts of a file, by index.
using PackedParts = std::map<int, std::shared_ptr<const PackedImage>>;

/// Writes `source` again with the given channels changed. Everything else stays exactly: channels, parts, types,
/// attributes (also those with names longer than 31 characters), windows, line order, tiles. A part without a change is
/// copied as compressed chunks, and so is a chunk whose pixels come out as they were. A changed part whose compression
/// is lossy (B44, B44A, DWAA, DWAB) becomes ZIP unless told otherwise; stale `preview` and `acesImageContainerFlag` are
/// dropped. Returns one note per such decision, for the log. The file is encoded in memory, checked, written under a
/// temporary name without ".exr" in the same folder, flushed to disk (fsync) and renamed: under its final name it is
/// complete or absent. Errors: cannot_create (folder missing or read-only), io (disk full ...), data (the source cannot
/// be decoded); the temporary is removed. `decoded`: what is there of the source's pixels already
/// (ExrReader::read_and_keep).
std::vector<std::string> write_exr(const ExrReader& source, std::span<const ChannelWrite> writes,
                                   const std::string& path, const WriteOptions& options,
                                   const PackedParts& decoded = {});

/// A new single-part scanline file (ZIP) from planes, for sequences made by tests and tools: same publishing as
/// write_exr.
struct NewChannel {
  std::string name;
  PixelType type;
  ConstPlaneView pixels;
};
struct NewFile {
  Window display_window, data_window;
  std::vector<NewChannel> channels;                    ///< all cover the data window
  std::vector<std::pair<std::string, Mat4>> matrices;  ///< written as m44f
  std::vector<std::pair<std::string, std::string>> texts;
};
void write_new_exr(const NewFile& file, const std::string& path);

}  // namespace aftershade::io
