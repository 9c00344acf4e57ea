#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/math/linear.h"

namespace aftershade::io {

enum class PixelType { half, single, uint };
std::string_view to_text(PixelType type);  ///< "half", "float", "uint"

struct ChannelInfo {
  std::string name;
  PixelType type;
};

/// One part of a file, flat and without subsampling or mip levels: anything else is refused when the file is opened.
struct PartInfo {
  std::string name;  ///< "" in most single-part files
  std::string view;  ///< the part's view attribute, or ""
  Window data_window;
  std::vector<ChannelInfo> channels;
  std::string compression;  ///< "none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"
  bool tiled = false;
  const ChannelInfo* find(std::string_view channel) const;
};

struct FileInfo {
  std::string path;
  Window display_window;
  float pixel_aspect = 1;
  std::vector<PartInfo> parts;
  std::vector<std::string> multi_view;  ///< of a single-part multi-view file; the first is the default view
};

/// Who decodes and encodes pixels. `openexr`: the OpenEXR library alone, to compare with and to find faults.
enum class PixelCodecs { automatic, openexr };

/// Limits that are checked before any pixel memory is taken (reliability 1.3).
struct ReadLimits {
  int max_width = 65536, max_height = 65536;
  int max_parts = 64, max_channels = 1024;
  int64_t max_frame_bytes = int64_t{4} << 30;
  PixelCodecs codecs = PixelCodecs::automatic;
};

/// Pixels that are no numbers.
struct NotNumbers {
  int64_t nan = 0, infinite = 0;
  NotNumbers& operator+=(const NotNumbers& other) {
    nan += other.nan;
    infinite += other.infinite;
    return *this;
  }
};
struct PackedImage;

/// An open EXR file. Every failure is Error(no_input) (missing, unreadable), Error(data) (not an EXR, damaged,
/// truncated, deep, subsampled, mip- or rip-mapped, over the limits) with the path in the text. Not for several threads
/// at once; reading spreads its work over all of them.
class ExrReader {
 public:
  explicit ExrReader(const std::string& path, const ReadLimits& limits = {});
  ~ExrReader();
  ExrReader(ExrReader&&) noexcept;
  const FileInfo& info() const;

  /// Attributes of a part's header, by exact name; nullopt when absent or of another type.
  std::optional<Mat4> matrix(int part, const std::string& name) const;       ///< m44f or m44d
  std::optional<double> number(int part, const std::string& name) const;     ///< float, double, int or rational
  std::optional<std::string> text(int part, const std::string& name) const;  ///< string
  std::vector<std::string> attribute_names(int part) const;

  /// A channel to read: `window` says which absolute pixels `target` covers; pixels of the target that lie outside the
  /// part's data window are left as they are. Values are converted to float.
  struct Request {
    std::string channel;
    PlaneView target;
    NotNumbers* found = nullptr;  ///< if not null, receives their count among the pixels that were read
  };
  void read(int part, std::span<const Request> requests, Window window) const;
  /// The same, and returns the decoded pixels of the whole part, for write_exr.
  std::shared_ptr<const PackedImage> read_and_keep(int part, std::span<const Request> requests, Window window) const;

  struct Handles;  ///< for the writer in this folder
  const Handles& handles() const { return *handles_; }

 private:
  void decode(int part, std::span<const Request> requests, Window window, PackedImage* keep) const;
  std::unique_ptr<Handles> handles_;
};

}  // namespace aftershade::io
