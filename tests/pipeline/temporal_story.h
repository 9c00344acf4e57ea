#pragma once
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/metrics/temporal_metrics.h"
#include "core/metrics/trail_metrics.h"
#include "core/parallel/rows.h"
#include "core/temporal/selective_temporal.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth.h"
#include "tests/support/truth_cache.h"

/// What temporal filters do to flicker, and what they leave behind moving objects, in figures (algorithms 12.2): the
/// story that the slides of seed 000 tell in pictures.
namespace aftershade::tests {

/// The frames that are filtered, and those that are judged: enough before them for a recursion to settle, enough on
/// both sides for a window.
inline constexpr int kStoryFirst = -5, kStoryLast = 22, kJudgedFirst = 6, kJudgedLast = 12;
inline constexpr int kTrailFrames = 8;      ///< k of T_k
inline constexpr double kSameDepth = 0.05;  ///< relative, for motion that a score may follow
inline constexpr float kFootprint = 0.05F;  ///< darkening by the moving objects from which on it is their footprint
inline constexpr int kDilation_px = 8;      ///< 4x4 texels at half resolution
inline constexpr float kContinuousDistance_m = 0.1F;

struct StorySize {
  int width = 240, height = 135;
  int rays = 256;  ///< of the truth, a pixel
};

struct StorySystem {
  std::string name;
  preset::Preset preset;  ///< stages that make AO at every pixel
};

inline std::string stage_of_method(const preset::Preset& preset, std::string_view method) {
  for (const auto& stage : preset.stages)
    if (preset::method_of(stage.params) == method) return stage.id;
  return "";
}

/// Every way to filter that the seeds have or consider, on the same AO where it is a filter alone.
inline std::vector<StorySystem> story_systems() {
  const auto shipped = preset::shipped_presets();
  const auto is_shipped = [&](const std::string& name) {
    return std::find(shipped.begin(), shipped.end(), name) != shipped.end();
  };
  const std::string base = "battlefield3-high";
  const std::string id = stage_of_method(ao_part(base), temporal::SelectiveTemporalParams::method);
  const auto plain = [&](const std::string& epsilon) {
    return ao_part(base, {id + ".selective=false", id + ".epsilon=" + epsilon});
  };
  std::vector<StorySystem> systems{
      {"no filter", ao_part(base, {id + ".remove=true"})},
      {"full resolution", ao_part(base, {id + ".remove=true", "ao.resolution=full"})},
      {"dual resolution", ao_part(base, {id + ".remove=true", "ao.resolution=dual"})},
      {"epsilon infinite", plain("1e9")},
      {"epsilon 0.1 %", plain("0.001")},
      {"epsilon 10 %", plain("0.1")},
      {"STF", ao_part(base)},
  };
  const std::string window = id + ".method=temporal-window";
  systems.push_back({"two-sided window", ao_part(base, {window})});
  systems.push_back({"two-sided window 10", ao_part(base, {window, id + ".frames=10"})});
  for (const char* name : {"soma", "accumulative-ssao", "temporal-refinement", "offline"})
    if (is_shipped(name)) systems.push_back({name, ao_part(name)});
  return systems;
}

inline const StorySystem& find_system(const std::vector<StorySystem>& systems, const std::string& name) {
  for (const StorySystem& system : systems)
    if (system.name == name) return system;
  throw std::out_of_range(name);
}

/// What a moving object leaves behind: the error of the AO against the one that the same system makes of that frame
/// alone, so that what the estimator has wrong does not count.
struct TrailScore {
  metrics::AgeError all;  ///< over T_k
  double half_life_frames;
};

struct StoryScore {
  metrics::Distribution unstable, stable;  ///< flicker above the ray-traced truth's own change
  /// Where objects move: floor that was in their AO's footprint (on all pixels, on stable ones), surfaces that they
  /// hid, surfaces newly in the footprint.
  std::optional<TrailScore> trail, stable_trail, ghost, lag;
};

/// Ray-traced AO in which every surface point is seen with the same rays in every frame, so that what is left of their
/// noise sticks to the surfaces and does not flicker.
inline Plane coherent_truth(const Scene& scene, double time, const StorySize& size) {
  const std::string key = cat("coherent ", scene.name, " of ", scene.objects.size(), " ", time, " ", size.width, " ",
                              size.height, " ", size.rays);
  auto planes = cached_planes(key, [&] {
    const PlacedScene placed(scene, time);
    const RayFan fan(camera_at(scene, time, size.width, size.height));
    AoTruth truth;
    truth.rays = size.rays;
    Plane out(size.width, size.height, 1);
    for_rows(size.height, [&](int y) {
      for (int x = 0; x < size.width; ++x)
        if (const auto hit = placed.trace(fan(x + 0.5, y + 0.5)))
          out(x, y) = static_cast<float>(ambient_occlusion_at(placed, hit->position, hit->normal, truth, 1));
    });
    std::vector<Plane> made;
    made.push_back(std::move(out));
    return made;
  });
  return std::move(planes.at(0));
}

/// The frames of a scene, rendered once.
class RenderedScene final : public FrameSource {
 public:
  RenderedScene(const Scene& scene, const StorySize& size) {
    for (int t = kStoryFirst; t <= kStoryLast; ++t)
      frames_[t] = render(scene, t, {size.width, size.height, 1}, kSceneRoles, false);
  }
  const Frame& at(int t) const { return frames_.at(t); }
  std::optional<Frame> load(int number, const std::string&, RoleSet roles, bool) override {
    const auto found = frames_.find(number);
    if (found == frames_.end()) return std::nullopt;
    Frame copy;
    copy.number = number;
    copy.window = found->second.window;
    copy.display = found->second.display;
    copy.camera = found->second.camera;
    for (const RoleInfo& role : kRoles)
      if (roles.contains(role.role))
        for (const Plane& plane : found->second.planes(role.role)) copy.planes(role.role).push_back(copy_of(plane));
    return copy;
  }

 private:
  std::map<int, Frame> frames_;
};

/// One scene with its truth, its motion and its masks.
class Story {
 public:
  Story(const std::string& scene_name, const StorySize& size)
      : size_(size), scene_(find_scene(scene_name)), source_(scene_, size) {
    AoTruth truth;
    truth.rays = size.rays;
    for (int t = kJudgedFirst; t <= kJudgedLast; ++t) {
      true_change_[t] = cached_ao_change(scene_name, t, size.width, size.height, truth);
      prepare(t);
    }
    const bool moves = std::any_of(scene_.objects.begin(), scene_.objects.end(), is_moving);
    if (moves) prepare_trails();
  }

  StoryScore score(const preset::Preset& preset) {
    const MemorySink all = run_frames(preset, kStoryFirst, kStoryLast);
    StoryScore out = flicker(all);
    if (footprints_.empty()) return out;
    std::map<int, Plane> alone;
    for (int t = kJudgedFirst; t <= kJudgedLast; ++t) alone[t] = ao_at(run_frames(preset, t, t), t);
    out.trail = trail(all, alone, left_);
    out.stable_trail = trail(all, alone, stable_left_);
    out.ghost = trail(all, alone, uncovered_);
    out.lag = trail(all, alone, entered_);
    return out;
  }

  /// Of an AO that never changes: the truth's own change, which is 0 where only the camera moves.
  StoryScore score_of_nothing() const {
    MemorySink open;
    for (int t = kJudgedFirst - 1; t <= kJudgedLast; ++t) open.planes[t]["AO"] = Plane(size_.width, size_.height, 1);
    return flicker(open);
  }

  /// Of the truth as an image: what reading it between pixels costs even an AO that is right everywhere.
  StoryScore score_of_truth() const {
    MemorySink truth;
    for (int t = kJudgedFirst - 1; t <= kJudgedLast; ++t) truth.planes[t]["AO"] = coherent_truth(scene_, t, size_);
    return flicker(truth);
  }

  Plane ao(const preset::Preset& preset, int t) { return ao_at(run_frames(preset, kStoryFirst, kStoryLast), t); }

 private:
  static bool is_moving(const Object& object) { return !object.motion.is_identity() && moves(object.motion); }
  static bool moves(const Motion& m) {
    return m.velocity.length() > 0 || m.orbit_turns_per_frame != 0 || m.spin_turns_per_frame != 0;
  }
  MemorySink run_frames(const preset::Preset& preset, int first, int last) {
    return run_over(preset, source_, frames_from_to(first, last), {"AO", false, {}});
  }
  static Plane ao_at(const MemorySink& sink, int t) { return copy_of(sink.planes.at(t).at("AO")); }

  struct Past {
    temporal::Reprojected where;
    Plane valid;
    metrics::Motion motion() const { return {where.x, where.y, valid}; }
  };

  /// Motion into frame t - 1, and the masks of frame t: from the depth at full resolution, the same for every filter.
  void prepare(int t) {
    const Frame &now = source_.at(t), &before = source_.at(t - 1);
    const auto& vectors = now.planes(Role::velocity_prev);
    Past& past = past_[t];
    past.where = temporal::reproject({.depth = now.depth(),
                                      .window = now.window,
                                      .camera = CameraReprojection::create(*now.camera, *before.camera),
                                      .mv_prev_x = vectors[0],
                                      .mv_prev_y = vectors[1]},
                                     temporal::ReprojectionSource::automatic, 0.5F);
    past.valid = metrics::same_surface({past.where.x, past.where.y, {}}, past.where.depth, before.depth(), kSameDepth);
    const filter::Surface surface{now.depth(), {}, {}, {}, local_projection(*now.camera, 0, 0), 0, 0, size_.height};
    temporal::SelectiveTemporalParams literal;
    literal.distance_m = kContinuousDistance_m;
    literal.distance_footprints = 0;
    const Plane continuous = temporal::continuity_mask(literal, filter::full_grid(surface), surface);
    stable_[t] = temporal::dilate_discontinuities(continuous, kDilation_px);
    unstable_[t] = Plane(size_.width, size_.height);
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x)
        unstable_[t](x, y) = stable_[t](x, y) < 0.5F && std::isfinite(now.depth()(x, y)) ? 1.0F : 0.0F;
  }

  /// Footprints: where the truth without the moving objects is lighter. Hidden: where they are seen themselves.
  void prepare_trails() {
    Scene empty = scene_;
    std::erase_if(empty.objects, is_moving);
    for (int t = kJudgedFirst - kTrailFrames; t <= kJudgedLast; ++t) {
      const Plane with = coherent_truth(scene_, t, size_), without = coherent_truth(empty, t, size_);
      const auto& vectors = source_.at(t).planes(Role::velocity_prev);
      Plane &footprint = footprints_[t], &hidden = hidden_[t];
      footprint = Plane(size_.width, size_.height);
      hidden = Plane(size_.width, size_.height);
      for (int y = 0; y < size_.height; ++y)
        for (int x = 0; x < size_.width; ++x) {
          hidden(x, y) = std::hypot(vectors[0](x, y), vectors[1](x, y)) > 0.01F ? 1.0F : 0.0F;
          footprint(x, y) = hidden(x, y) < 0.5F && without(x, y) - with(x, y) > kFootprint ? 1.0F : 0.0F;
        }
    }
    for (int t = kJudgedFirst; t <= kJudgedLast; ++t) {
      const auto since = [&](const std::map<int, Plane>& planes) {
        std::vector<ConstPlaneView> views;
        for (int i = t - kTrailFrames; i <= t; ++i) views.push_back(planes.at(i));
        return views;
      };
      left_[t] = where(metrics::frames_since_left(since(footprints_)), hidden_.at(t), false);
      stable_left_[t] = where(left_[t], stable_.at(t), true);
      uncovered_[t] = metrics::frames_since_left(since(hidden_));
      entered_[t] = metrics::frames_since_entered(since(footprints_));
    }
  }

  static Plane where(const Plane& ages, const Plane& mask, bool set) {
    Plane out(ages.width(), ages.height());
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) out(x, y) = (mask(x, y) > 0.5F) == set ? ages(x, y) : 0.0F;
    return out;
  }

  StoryScore flicker(const MemorySink& all) const {
    std::vector<Plane> maps;
    std::vector<ConstPlaneView> views, unstable, stable;
    for (int t = kJudgedFirst; t <= kJudgedLast; ++t) {
      maps.push_back(metrics::flicker_above_truth(all.planes.at(t).at("AO"), all.planes.at(t - 1).at("AO"),
                                                  true_change_.at(t), past_.at(t).motion()));
      unstable.push_back(unstable_.at(t));
      stable.push_back(stable_.at(t));
    }
    views.assign(maps.begin(), maps.end());
    return {metrics::distribution(views, unstable), metrics::distribution(views, stable), {}, {}, {}, {}};
  }

  TrailScore trail(const MemorySink& all, const std::map<int, Plane>& alone, const std::map<int, Plane>& ages) const {
    std::vector<ConstPlaneView> images, references, of_age;
    for (int t = kJudgedFirst; t <= kJudgedLast; ++t) {
      images.push_back(all.planes.at(t).at("AO"));
      references.push_back(alone.at(t));
      of_age.push_back(ages.at(t));
    }
    const auto by_age = metrics::error_by_age(images, references, of_age, kTrailFrames);
    std::vector<double> means;
    for (const metrics::AgeError& age : by_age) means.push_back(age.mean);
    return {metrics::total_error(by_age), metrics::half_life_frames(means)};
  }

  StorySize size_;
  const Scene& scene_;
  RenderedScene source_;
  std::map<int, Plane> true_change_, stable_, unstable_, footprints_, hidden_, left_, stable_left_, uncovered_,
      entered_;
  std::map<int, Past> past_;
};

}  // namespace aftershade::tests
