#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/embedded.h"
#include "core/image/role.h"
#include "core/io/exr_reader.h"

/// Producer profiles: what a renderer or compositor calls its channels and how it encodes them, as data
/// (configs/profiles).
namespace aftershade::io {

enum class DepthKind { planar, ray, device, device_reversed, inverse };
/// Their names in profiles and on the command line.
inline constexpr std::array<std::pair<std::string_view, DepthKind>, 5> kDepthKinds{
    {{"planar", DepthKind::planar},
     {"ray", DepthKind::ray},
     {"device", DepthKind::device},
     {"device-reversed", DepthKind::device_reversed},
     {"inverse", DepthKind::inverse}}};
std::optional<DepthKind> depth_kind_named(std::string_view name);
enum class NormalSpace { world, camera };
enum class VelocityUnit { pixels, screen };  ///< screen: 1 is the whole width or height of the display window

/// How the stored numbers of a role become canonical ones; only the members of that role matter.
struct Encoding {
  DepthKind depth_kind = DepthKind::planar;
  double background_above = 1e8;    ///< depth at or above this (stored units) is background
  bool zero_is_background = false;  ///< a stored depth of 0 is background
  NormalSpace normal_space = NormalSpace::world;
  std::array<double, 3> scale{1, 1, 1};  ///< value = (stored - neutral) * scale, per channel
  double neutral = 0;
  VelocityUnit velocity_unit = VelocityUnit::pixels;
  double sentinel_above = 0;  ///< |stored| at or above this is "no vector"; 0: none
  bool multiply = false;      ///< ambient: product of the two channel groups (Blender's DiffInd x DiffCol)
};

/// One way in which a role may be stored: channel name patterns (`*` any run of characters; view tokens are stripped
/// first).
struct Candidate {
  std::vector<std::string> channels;  ///< as many as the role has planes; twice as many with `multiply`
  Encoding encoding;
};

/// Attribute names (patterns; the identical spelling goes first).
struct CameraAttributes {
  std::string world_to_camera = "worldToCamera";
  std::string world_to_ndc = "worldToNDC";
};

struct Profile {
  std::string name, description;
  struct Sign {                       ///< any one sign is enough to recognise the producer
    std::string attribute, contains;  ///< attribute name (pattern) and, if not empty, a piece of its text
    std::string channel;              ///< or a channel name pattern
  };
  std::vector<Sign> detect;
  std::vector<std::vector<std::string>> color;           ///< R G B [A], in order of preference
  std::array<std::vector<Candidate>, kRoleCount> roles;  ///< depth2 is encoded as depth is: its candidates are names
  CameraAttributes camera;
  std::string unit = "m";
};

std::span<const EmbeddedFile> builtin_profiles();
/// Parses a profile; throws Error(config) naming the file, key and what is wrong.
Profile parse_profile(std::string_view json, std::string_view file_name);
/// A shipped profile by name, or a .json file; Error(config) with "did you mean".
Profile load_profile(const std::string& name_or_file);
/// The first shipped profile with a sign that the file shows, and which; "generic" when none does.
struct Detected {
  Profile profile;
  std::string why;  ///< "attribute BlenderMultiChannel", "channel ViewLayer.Combined.R", "no known producer"
};
Detected detect_profile(const ExrReader& file);

}  // namespace aftershade::io
