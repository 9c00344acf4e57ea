#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/exr_handles.h"
#include "core/io/exr_writer.h"

/// What write_exr will do, decided before a pixel is decoded.
namespace aftershade::io {

/// A part of the output: copied from the source, or encoded again.
struct PlannedPart {
  int source_part = 0;
  RawHeader header;                  ///< as it will stand in the file
  Geometry geometry;                 ///< of the output
  std::vector<RawChannel> channels;  ///< of the output, in the file's order
  bool copy_channels = true;         ///< false: the new channels alone
  struct Write {
    std::string channel;  ///< its name in the output
    const ChannelWrite* write;
  };
  std::vector<Write> writes;
  bool encode = false;  ///< else the chunks are copied
};

struct Plan {
  uint32_t version = 0;
  std::vector<PlannedPart> parts;
  std::vector<std::string> notes;
};

/// Throws Error(usage) for an unknown compression, Error(internal) for writes that fit no channel.
Plan plan_output(const ExrReader::Handles& source, std::span<const ChannelWrite> writes, const WriteOptions& options);

}  // namespace aftershade::io
