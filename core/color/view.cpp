#include "core/color/view.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::color {

namespace {

ocio::ConstTransformRcPtr clamp_to_display() {
  const auto clamp = ocio::RangeTransform::Create();
  clamp->setMinInValue(0);
  clamp->setMinOutValue(0);
  clamp->setMaxInValue(1);
  clamp->setMaxOutValue(1);
  return clamp;
}

ocio::ConstTransformRcPtr built_in(const char* style, ocio::TransformDirection direction) {
  const auto transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style);
  transform->setDirection(direction);
  return transform;
}

void add_srgb(ocio::GroupTransform& group) {
  const auto curve = ocio::ExponentWithLinearTransform::Create();
  curve->setGamma({2.4, 2.4, 2.4, 1.0});
  curve->setOffset({0.055, 0.055, 0.055, 0.0});
  curve->setDirection(ocio::TRANSFORM_DIR_INVERSE);  // forward decodes display values
  group.appendTransform(std::const_pointer_cast<ocio::Transform>(clamp_to_display()));
  group.appendTransform(curve);
}

void add_aces(ocio::GroupTransform& group) {
  const std::array<ocio::ConstTransformRcPtr, 4> steps{
      built_in("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE),
      built_in("ACEScg_to_ACES2065-1", ocio::TRANSFORM_DIR_FORWARD),
      built_in("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0", ocio::TRANSFORM_DIR_FORWARD),
      built_in("DISPLAY - CIE-XYZ-D65_to_sRGB", ocio::TRANSFORM_DIR_FORWARD)};
  for (const auto& step : steps) group.appendTransform(std::const_pointer_cast<ocio::Transform>(step));
}

void add_raw(ocio::GroupTransform& group) {
  group.appendTransform(std::const_pointer_cast<ocio::Transform>(clamp_to_display()));
}

struct BuiltInView {
  std::string_view name;
  void (*add)(ocio::GroupTransform& group);
};
constexpr std::array<BuiltInView, 3> kBuiltInViews{{{"sRGB", add_srgb}, {"ACES 1.0 SDR", add_aces}, {"Raw", add_raw}}};

[[noreturn]] void no_view(const std::string& name, std::string_view where, const std::vector<std::string>& known) {
  throw Error(ErrorCode::usage, cat("there is no view \"", name, "\" in ", where),
              cat(did_you_mean(name, known), nearest(name, known) ? " " : "", "there are: ", join(known, ", ")));
}

/// A view of a configuration file and the display that it belongs to.
struct Place {
  std::string display, view;
};

/// The default display's views come first.
std::vector<Place> places(const ocio::Config& config) {
  std::vector<Place> out;
  const std::string first = config.getDefaultDisplay();
  const auto add = [&](const std::string& display) {
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
      out.push_back({display, config.getView(display.c_str(), i)});
  };
  add(first);
  for (int i = 0; i < config.getNumDisplays(); ++i)
    if (config.getDisplay(i) != first) add(config.getDisplay(i));
  return out;
}

Place place_of(const ocio::Config& config, const std::string& path, const std::string& name) {
  if (name.empty()) return {config.getDefaultDisplay(), config.getDefaultView(config.getDefaultDisplay())};
  const std::vector<Place> all = places(config);
  const auto find = [&](auto&& matches) { return std::find_if(all.begin(), all.end(), matches); };
  auto found = find([&](const Place& place) { return place.view == name; });
  if (found == all.end()) found = find([&](const Place& place) { return place.display + "/" + place.view == name; });
  if (found != all.end()) return *found;
  std::vector<std::string> known;
  for (const Place& place : all)
    known.push_back(place.display == all.front().display ? place.view : place.display + "/" + place.view);
  no_view(name, path, known);
}

}  // namespace

View built_in_view(const std::string& name) {
  const auto found = std::find_if(kBuiltInViews.begin(), kBuiltInViews.end(),
                                  [&](const BuiltInView& view) { return view.name == (name.empty() ? "sRGB" : name); });
  if (found == kBuiltInViews.end()) {
    std::vector<std::string> known;
    for (const BuiltInView& view : kBuiltInViews) known.emplace_back(view.name);
    no_view(name, "the built-in configuration", known);
  }
  try {
    const auto group = ocio::GroupTransform::Create();
    found->add(*group);
    return {std::string(found->name), ocio::Config::CreateRaw()->getProcessor(group)->getDefaultCPUProcessor()};
  } catch (const ocio::Exception& error) {
    throw Error(ErrorCode::internal, cat("OpenColorIO cannot make the view ", found->name, ": ", error.what()),
                "check the OpenColorIO installation");
  }
}

View view_of_file(const std::string& path, const std::string& name) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(ErrorCode::no_input, cat("there is no OpenColorIO configuration ", path));
  try {
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(path.c_str());
    const Place place = place_of(*config, path, name);
    const auto processor = config->getProcessor(ocio::ROLE_SCENE_LINEAR, place.display.c_str(), place.view.c_str(),
                                                ocio::TRANSFORM_DIR_FORWARD);
    const std::string file = std::filesystem::path(path).filename().string();
    return {cat(place.display, "/", place.view, " (", file, ")"), processor->getDefaultCPUProcessor()};
  } catch (const ocio::Exception& error) {
    throw Error(ErrorCode::config, cat(path, ": OpenColorIO cannot use this configuration: ", error.what()),
                "check the file with ociocheck");
  }
}

}  // namespace aftershade::color
