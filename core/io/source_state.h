#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/io/conversions.h"
#include "core/io/file_source.h"

namespace aftershade::io {

/// A layer that will be loaded, and for which effects.
struct LayerChoice {
  ColorBinding binding;
  bool ao = false, blur = false;
};

/// A channel that a filter works on.
struct NamedChoice {
  std::string name;  ///< as the preset has it
  ChannelRef ref;
};

/// What one view of the sequence offers.
struct ViewState {
  std::vector<RoleBinding> roles;
  std::vector<ColorBinding> colors;
  std::vector<LayerChoice> layers;
  std::vector<NamedChoice> named;
  RoleSet available;
  int part = 0;  ///< of the beauty, else the view's first: where added channels go
  bool header_camera = false;
};

/// SourceOptions::first_frame, and what was found in it; constant once made.
struct Resolved {
  FileInfo first;
  std::vector<FileInfo> siblings;
  std::map<std::string, ViewState> views;
};
Resolved resolve(const SourceOptions& options);

/// The camera of a frame: header, camera file or field of view. `note` receives a warning.
std::optional<Camera> find_camera(const ExrReader& file, const SourceOptions& options, int number,
                                  const std::string& view, std::string* note);
/// Has a part of the view usable camera attributes?
bool has_header_camera(const ExrReader& file, const SourceOptions& options, const std::string& view);

/// What the camera and the options say about a depth.
DepthContext depth_context(const SourceOptions& options, const std::optional<Camera>& camera, Window window);

/// The data window of a part.
Window data_window(const ExrReader& file, int part);

/// Error(data) with both values when a frame does not fit the first one.
void check_same_shape(const FileInfo& frame, const FileInfo& first);
void check_part(const FileInfo& frame, const FileInfo& first, int part);
void check_channel(const FileInfo& frame, const FileInfo& first, const ChannelRef& ref, std::string_view use);
/// Every channel and its type must be that of the first frame.
void check_channel_set(const FileInfo& frame, const FileInfo& first);

std::string window_text(Window window);  ///< "(0, 0)-(1919, 1079)"

/// Channels to decode into planes that all cover one window.
class PlaneReader {
 public:
  /// `outside`: what the plane holds where the file has no pixel.
  void add(const ExrReader& file, const ChannelRef& ref, Plane& target, float outside, bool infinity_is_meant = false);
  /// Makes the planes. Each part is decoded once; those that have an entry in `keep`, of `kept_file`, are left there.
  /// Counts pixels of the data windows that are no numbers.
  NanReport read(Window window, bool nan_is_error, const ExrReader* kept_file = nullptr,
                 PackedParts* keep = nullptr) const;

 private:
  struct Job {
    const ExrReader* file;
    ChannelRef ref;
    Plane* target;
    float outside;
    bool infinity_is_meant;
  };
  NanReport report(const std::vector<NotNumbers>& found, bool nan_is_error) const;
  std::vector<Job> jobs_;
};

}  // namespace aftershade::io
