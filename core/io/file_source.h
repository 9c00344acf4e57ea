#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image/frame.h"
#include "core/io/camera_attributes.h"
#include "core/io/exr_writer.h"
#include "core/io/profile.h"
#include "core/io/roles.h"
#include "core/io/sequence.h"

namespace aftershade::io {

/// Where the user puts a role in another sequence: --role depth=depth.####.exr
struct Sibling {
  Role role;
  Sequence sequence;
};

/// Everything that turns files into canonical frames, resolved and validated before frame 1.
struct SourceOptions {
  Sequence sequence;
  /// The frame that views, roles and layers are resolved from and that all others are compared with; default: the first
  /// of the sequence. Frames before it can be loaded too, as long as they have its shape.
  std::optional<int> first_frame;
  Profile profile;
  std::map<std::string, std::string> channel_overrides;  ///< role name -> channel names, comma separated
  std::vector<Sibling> siblings;
  std::optional<DepthKind> depth_kind;          ///< overrides the profile
  std::optional<double> near_plane, far_plane;  ///< stored units; needed by device depth
  double metres_per_unit = 1;
  std::shared_ptr<const CameraFile> camera_file;
  std::optional<double> fov_deg;                    ///< horizontal; a camera without position
  std::vector<std::string> ao_layers, blur_layers;  ///< layer names; empty: the beauty. "beauty" names the beauty
  /// Channels that stages filter (pipeline::named_channels), without view; Frame::named.
  std::vector<std::string> named_channels;
  bool nan_is_error = false;
  /// Frames with layers carry Frame::file: the decoded pixels of the parts that will be written again.
  bool keep_file = false;
  ReadLimits limits;
};

/// Counts of pixels that are no numbers, per channel name.
struct NanReport {
  std::map<std::string, int64_t> nan, infinite;
};

/// Frames from EXR files. The constructor refuses depth that cannot become planar. Each header is checked against the
/// first frame's (display window, channels, pixel aspect: Error(data) with frame and both values). Converts depth,
/// normals, velocity and camera to canonical form; NaN and Inf colours stay in the layers, counted.
///
/// A frame's window is the union of the data windows of all roles of the view that can be loaded, of its chosen layers,
/// its named channels and Frame::part, whichever of them are loaded: what is computed from a frame does not depend on
/// what else was asked for. A sibling sequence that lacks the frame has no part in it.
class FileSource final : public FrameSource {
 public:
  explicit FileSource(SourceOptions options);
  ~FileSource() override;
  /// Named channels are always loaded.
  /// Whoever asks for depth2 gets depth too: where the second is not beyond the first, it is +inf.
  /// May be called by several threads at once, if on_nan and on_note may: they are called by the loading threads.
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override;

  /// Throws Error(usage) when a named channel belongs to a layer that --ao-layers and --blur-layers chose (the beauty
  /// if they did not): stages that change layers and stages that filter channels cannot both have it.
  void check_layers_and_named(const std::string& view) const;

  /// What the first frame shows; views, roles and layers are those of the whole sequence.
  const FileInfo& info() const;
  std::vector<std::string> views() const;
  const std::vector<RoleBinding>& roles(const std::string& view) const;
  const std::vector<ColorBinding>& layers(const std::string& view) const;
  RoleSet available(const std::string& view) const;
  /// Do the frames have camera matrices of their own? Then a camera file is not used.
  bool has_header_camera(const std::string& view) const;

  /// SourceOptions::keep_file from now on.
  void keep_files(bool keep);

  /// Called once per loaded frame that has NaN or Inf in a channel.
  std::function<void(int frame, const NanReport&)> on_nan;
  /// What the log should say about the input, again for each frame: a role that cannot be used, a camera that looks
  /// wrong.
  std::function<void(int frame, const std::string&)> on_note;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct SinkOptions {
  WriteOptions write;
  ReadLimits limits{};                                   ///< those of the source
  std::function<std::string(int)> path;                  ///< output path of a frame
  std::function<void(int, const std::string&)> on_note;  ///< notes of write_exr
};
/// Frames to EXR files: the source frame's file with changed layers and added channels (write_exr). A changed layer is
/// written where its data window and the planes overlap; added channels cover the data window of Frame::part, or what
/// it grows to, and overwrite channels of their name that the part has. Those that are named channels of the file stay
/// in their own part and data window, and are left out of files with new channels alone. What Frame::file holds of the
/// source is not read again.
class FileSink final : public FrameSink {
 public:
  FileSink(const Sequence& sources, SinkOptions options);
  /// May be called by several threads at once, if SinkOptions::path and on_note may.
  void write(int number, const std::vector<Frame>& views) override;

 private:
  const Sequence& sources_;
  SinkOptions options_;
};

}  // namespace aftershade::io
