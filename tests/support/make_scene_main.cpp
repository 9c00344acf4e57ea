#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "tests/support/scene_files.h"
#include "tests/support/scenes.h"

/// make_scene SCENE -o DIR [...]: writes frames of a synthetic scene as EXR files, and exact truth beside them.
namespace aftershade::tests {
namespace {

constexpr const char* kUsage =
    "make_scene SCENE -o DIR [--frames 1-8] [--size 480x270] [--samples 16] [--noise 0] [--depth2]\n"
    "           [--truth ao,blur] [--ao-radius 1] [--ao-rays 256] [--shutter 0.5] [--blur-samples 64]\n"
    "writes DIR/SCENE.####.exr (with --depth2 also channel depth2.Z: what lies behind the first surface), and with\n"
    "--truth DIR/SCENE_ao.####.exr (cosine-weighted, hard radius in metres) and DIR/SCENE_blur.####.exr (centred box\n"
    "shutter, in frames). Scenes:\n";

struct Options {
  std::string scene, folder;
  int first = 1, last = 8;
  RenderSettings settings{480, 270, 16};
  double noise = 0, shutter_frames = 0.5;
  bool depth2 = false, ao = false, blur = false;
  AoTruth ao_truth{};
  int blur_samples = 64;
};

[[noreturn]] void usage_error(const std::string& message) {
  throw Error(ErrorCode::usage, message, "make_scene --help shows the options");
}

double number(const std::string& option, const std::string& text) {
  const auto value = parse_number(text);
  if (!value) usage_error(cat(option, ": \"", text, "\" is no number"));
  return *value;
}
int integer(const std::string& option, const std::string& text) {
  const auto value = parse_integer(text);
  if (!value) usage_error(cat(option, ": \"", text, "\" is no whole number"));
  return *value;
}
/// "a<separator>b", or a alone for both.
std::pair<int, int> integers(const std::string& option, const std::string& text, char separator) {
  const auto parts = split(text, separator);
  return {integer(option, parts.front()), integer(option, parts.back())};
}

void set_truth(Options& options, const std::string& list) {
  for (const std::string& what : split(list, ',')) {
    if (what != "ao" && what != "blur") usage_error(cat("--truth: \"", what, "\" is neither ao nor blur"));
    (what == "ao" ? options.ao : options.blur) = true;
  }
}

void set_option(Options& options, const std::string& name, const std::string& value) {
  if (name == "-o")
    options.folder = value;
  else if (name == "--frames")
    std::tie(options.first, options.last) = integers(name, value, '-');
  else if (name == "--size")
    std::tie(options.settings.width, options.settings.height) = integers(name, value, 'x');
  else if (name == "--samples")
    options.settings.colour_samples = integer(name, value);
  else if (name == "--noise")
    options.noise = number(name, value);
  else if (name == "--truth")
    set_truth(options, value);
  else if (name == "--ao-radius")
    options.ao_truth.radius_m = number(name, value);
  else if (name == "--ao-rays")
    options.ao_truth.rays = integer(name, value);
  else if (name == "--shutter")
    options.shutter_frames = number(name, value);
  else if (name == "--blur-samples")
    options.blur_samples = integer(name, value);
  else
    usage_error(cat("unknown option ", name));
}

Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--depth2") {
      options.depth2 = true;
    } else if (arguments[i].starts_with("-")) {
      if (i + 1 == arguments.size()) usage_error(cat(arguments[i], " needs a value"));
      set_option(options, arguments[i], arguments[i + 1]);
      ++i;
    } else {
      options.scene = arguments[i];
    }
  }
  if (options.scene.empty() || options.folder.empty()) usage_error("a scene and -o DIR are needed");
  if (options.settings.width < 1 || options.settings.height < 1) usage_error("--size: at least 1x1 is needed");
  return options;
}

std::string frame_path(const Options& options, const std::string& suffix, int frame) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "%04d", frame);
  return cat(options.folder, "/", options.scene, suffix, ".", digits, ".exr");
}

void write_frame(const Options& options, const Scene& scene, int number) {
  const RenderSettings& size = options.settings;
  RoleSet roles = kSceneRoles;
  if (options.depth2) roles.insert(Role::depth2);
  Frame frame = render(scene, number, size, roles);
  if (options.noise > 0) add_render_noise(frame, options.noise);
  write_scene_file(frame, frame_path(options, "", number));
  if (options.ao)
    write_ao_file(frame, ambient_occlusion_truth(scene, number, size.width, size.height, options.ao_truth),
                  frame_path(options, "_ao", number));
  if (options.blur)
    write_color_file(frame, motion_blur_truth(scene, number, options.shutter_frames, options.blur_samples, size),
                     frame_path(options, "_blur", number));
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments[0] == "-h" || arguments[0] == "--help") {
    std::cout << kUsage;
    for (const Scene& scene : scenes()) std::cout << "  " << scene.name << ": " << scene.description << "\n";
    return 0;
  }
  const Options options = parse(arguments);
  const Scene& scene = find_scene(options.scene);
  std::filesystem::create_directories(options.folder);
  for (int frame = options.first; frame <= options.last; ++frame) write_frame(options, scene, frame);
  return 0;
}

}  // namespace
}  // namespace aftershade::tests

int main(int argc, char** argv) {
  try {
    return aftershade::tests::run({argv + 1, argv + argc});
  } catch (const aftershade::Error& error) {
    std::cerr << "make_scene: " << error.what() << "\n";
    return aftershade::exit_status(error.code());
  } catch (const std::exception& error) {
    std::cerr << "make_scene: " << error.what() << "\n";
    return 70;
  }
}
