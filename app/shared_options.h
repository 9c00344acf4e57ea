#pragma once
#include <string>
#include <vector>

#include "app/option_table.h"
#include "core/io/profile.h"

/// Options that several commands have.
namespace aftershade::app {

inline std::vector<std::string> depth_kind_names() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : io::kDepthKinds) names.emplace_back(name);
  return names;
}

/// How INPUT becomes frames: InputArgs.
template <class Args>
void add_input(std::vector<Option<Args>>& t) {
  t.push_back({"--frames", "RANGE", &Args::frames,
               "frames to work on: 1001-1100, 1001-1100x2, -5-10, 1,5,7-9; neighbours are read from disk as needed"});
  t.push_back({"--hash-digits",
               "MEANING",
               &Args::hash_digits,
               "what one # stands for: one digit, or OpenImageIO's four",
               {"one", "oiio"}});
  t.push_back({"--view", "NAME", &Args::views, "a view of a multi-view file; may be repeated; all views by default"});
  t.push_back({"--profile", "NAME|FILE", &Args::profile, "producer profile; recognised from the file by default"});
  t.push_back({"--channel", "ROLE=NAMES", &Args::channels,
               "the channels of a role, such as depth=foo.Z or velocity_next=mv.x,mv.y; roles: color, depth, depth2, "
               "normal, velocity_prev, velocity_next, ambient, ao"});
  t.push_back(
      {"--role", "ROLE=INPUT", &Args::roles, "takes a role from another sequence, such as depth=depth.####.exr"});
  t.push_back({"--depth-kind", "KIND", &Args::depth_kind, "how depth is stored", depth_kind_names()});
  t.push_back({"--near", "LENGTH", &Args::near_plane, "near clip plane in the file's unit, for device depth"});
  t.push_back({"--far", "LENGTH", &Args::far_plane, "far clip plane in the file's unit, for device depth"});
  t.push_back({"--unit", "UNIT", &Args::unit, "unit of length in the files: m, cm, mm, ft or metres per unit"});
  t.push_back({"--camera", "FILE.json", &Args::camera,
               "camera file for the sequence, see aftershade-camera(5); used where the header has no matrices"});
  t.push_back({"--fov", "DEGREES", &Args::fov_deg, "horizontal field of view, when nothing else tells it"});
  t.push_back(
      {"--ao-layers", "NAME", &Args::ao_layers, "a layer to darken by AO; may be repeated; the beauty by default"});
  t.push_back({"--blur-layers", "NAME", &Args::blur_layers,
               "a layer to blur; may be repeated; the beauty with its alpha by default"});
  t.push_back(
      {"--nan", "POLICY", &Args::nan, "pixels that are no numbers: keep and count them, or fail", {"keep", "error"}});
}

/// Which preset runs, changed how: PresetArgs.
template <class Args>
void add_preset(std::vector<Option<Args>>& t) {
  t.push_back({"-p,--preset", "NAME|FILE", &Args::preset,
               "shipped preset or preset file, see aftershade-preset(5); high-dx11 by default"});
  t.push_back({"--set", "ID.KEY=VALUE", &Args::sets, "changes one value of the preset; may be repeated"});
  t.push_back({"--only", "ID", &Args::only, "runs only this stage of the preset; may be repeated"});
  t.push_back({"--skip", "ID", &Args::skip, "leaves this stage of the preset out; may be repeated"});
}

/// Threads and how much is said: CommonArgs.
template <class Args>
void add_common(std::vector<Option<Args>>& t) {
  t.push_back(
      {"--threads", "N", &Args::threads, "threads to use; 0: all that the machine allows", {}, false, {{0, 1024}}});
  t.push_back({"-q,--quiet", "", &Args::quiet, "errors only"});
  t.push_back({"-v,--verbose", "", &Args::verbose, "says more: stages and their times, every note of every frame"});
}

}  // namespace aftershade::app
