#pragma once
#include <memory>

#include "core/image/frame.h"
#include "core/io/exr_pixels.h"
#include "core/io/exr_writer.h"

namespace aftershade::io {

/// What FileSource keeps of a frame's file for FileSink: the open file, and the pixels of the parts that it decoded.
struct DecodedFile final : FileData {
  explicit DecodedFile(ExrReader file) : reader(std::move(file)) {}
  ExrReader reader;
  PackedParts parts;
};

}  // namespace aftershade::io
