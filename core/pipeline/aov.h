#pragma once
#include <array>
#include <bitset>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/preset/preset.h"

/// Arbitrary output variables: the intermediate results that stages can add to the files, as half channels
/// "aftershade.NAME" (of vectors "aftershade.NAME.x" and "aftershade.NAME.y"). A stage says in Needs::aovs which of
/// them it has, and works out none that nobody asked for (Work::wants). If several stages have one, the last stays.
namespace aftershade::pipeline {

enum class Aov {
  ao_raw,
  ao_blurred,
  ao_upsampled,
  ao_filtered,
  thickness,
  mask,
  history_age,
  history_weight,
  window_weight,
  confidence,
  rejected,
  tile_velocity,
  neighbour_velocity,
  guessed,
};
inline constexpr int kAovCount = 14;

struct AovInfo {
  Aov aov;
  std::string_view name;  ///< as the command line spells it, and in the file behind "aftershade."
  bool is_vector;         ///< two channels, .x and .y
  std::string_view doc;
};
/// What they are called and mean, in the order of the pipeline.
inline constexpr std::array<AovInfo, kAovCount> kAovs{{
    {Aov::ao_raw, "ao_raw", false, "AO of this frame alone before any filter, 1 = open, at every pixel"},
    {Aov::ao_blurred, "ao_blurred", false, "AO after the spatial blur, 1 = open"},
    {Aov::ao_upsampled, "ao_upsampled", false, "AO after it was brought to full resolution, 1 = open"},
    {Aov::ao_filtered, "ao_filtered", false, "AO after the temporal filter, 1 = open"},
    {Aov::thickness, "thickness", false, "for how many metres behind its front a surface occludes; 0: no surface"},
    {Aov::mask, "mask", false, "1: stable, keeps the AO of its frame; 0: near a depth discontinuity, filtered in time"},
    {Aov::history_age, "history_age", false,
     "how many frames' AO is in the result, or, of temporal-refinement, how many samples"},
    {Aov::history_weight, "history_weight", false, "share of the result that comes from the frame before, 0 to 1"},
    {Aov::window_weight, "window_weight", false,
     "weight of all frames of the window that were used over that of a whole window, to 1"},
    {Aov::confidence, "confidence", false,
     "how far the AO of the frame before still holds, as the samples tell, 0 to 1"},
    {Aov::rejected, "rejected", false,
     "what became of the history: 0 no surface, 1 used, 2 not asked for (stable), 3 there is none (first frame, cut), "
     "4 motion unknown, 5 outside the image before, 6 another surface was there (disocclusion), 7 surroundings "
     "changed (sample validation), 8 the value itself changed"},
    {Aov::tile_velocity, "tile_velocity", true,
     "the motion blur's longest velocity in the pixel's tile, pixels, y down, half an exposure"},
    {Aov::neighbour_velocity, "neighbour_velocity", true,
     "the longest velocity that reaches the tile from around it, pixels, y down, half an exposure"},
    {Aov::guessed, "guessed", false, "share of the blurred pixel that no frame shows and a guess stands for, 0 to 1"},
}};
constexpr const AovInfo& info(Aov aov) { return kAovs[static_cast<size_t>(aov)]; }

/// The channels of an AOV in a file, without view.
inline std::vector<std::string> channels_of(Aov aov) {
  const std::string name = "aftershade." + std::string(info(aov).name);
  if (info(aov).is_vector) return {name + ".x", name + ".y"};
  return {name};
}

inline std::optional<Aov> aov_from_name(std::string_view name) {
  for (const AovInfo& entry : kAovs)
    if (entry.name == name) return entry.aov;
  return std::nullopt;
}

/// A set of AOVs.
class AovSet {
 public:
  AovSet() = default;
  AovSet(std::initializer_list<Aov> aovs) {
    for (const Aov aov : aovs) insert(aov);
  }
  /// All that any stage has.
  static AovSet all() {
    AovSet set;
    set.bits_.set();
    return set;
  }
  void insert(Aov aov) { bits_.set(static_cast<size_t>(aov)); }
  void insert(AovSet other) { bits_ |= other.bits_; }
  bool contains(Aov aov) const { return bits_.test(static_cast<size_t>(aov)); }
  bool empty() const { return bits_.none(); }

 private:
  std::bitset<kAovCount> bits_;
};

/// What the stages of a preset have; `layers` as Outputs::layers.
AovSet aovs_of(const preset::Preset& preset, bool layers = true);

std::vector<std::string> names_of(AovSet aovs);

/// The set that comma-separated lists of names tell; "all" is `offered`. Throws Error(usage) for what is not offered.
AovSet aovs_from_names(const std::vector<std::string>& lists, AovSet offered);

}  // namespace aftershade::pipeline
