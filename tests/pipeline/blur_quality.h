#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/metrics/flip.h"
#include "core/metrics/temporal_metrics.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/pipeline/disocclusion.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth_cache.h"

/// Motion blur against accumulated truth, for a shutter of half a frame centred on the frame: what the benchmarks print
/// and tests may bound.
namespace aftershade::tests {

inline constexpr double kShutter_frames = 0.5;
inline constexpr int kShutterSamples = 64;

/// A motion blur alone: a shipped preset's stage "motion_blur", or a method with its defaults.
struct BlurMethod {
  const char* name;
  const char* preset = nullptr;
  const char* method = nullptr;
  bool has_clamp = false;  ///< max_radius_px, which is also its tile, shortens velocities; it is also measured lifted
  int tile_px = 0;         ///< of a method whose tiles have one size
};
/// THE list of the benchmarks: a line adds a method. The first is no blur at all.
inline constexpr BlurMethod kBlurMethods[] = {
    {.name = "none"},
    {.name = "vv-current-gen", .preset = "vicarious-visions-current-gen", .has_clamp = true},
    {.name = "vv-dx11", .preset = "vicarious-visions-dx11", .has_clamp = true},
    {.name = "mcguire2012", .preset = "mcguire2012", .has_clamp = true},
    {.name = "guertin2014", .preset = "guertin2014", .has_clamp = true},
    {.name = "gather-plus", .method = "gather-plus", .tile_px = 16},
    {.name = "reconstruct", .method = "reconstruct", .tile_px = 32},
};

/// One stage, "motion_blur".
inline preset::Preset preset_of(const BlurMethod& method, const params::Json& values = params::Json::object()) {
  params::Json stage{{"id", "motion_blur"}};
  if (method.method) stage["method"] = method.method;
  if (method.preset) {
    const params::Json whole = preset::to_json(preset::load_preset(method.preset).preset);
    for (const params::Json& other : whole.at("stages"))
      if (other.at("id") == "motion_blur") stage = other;
  }
  stage.update(values);
  return preset::from_json({{"description", method.name}, {"stages", params::Json::array({stage})}}, method.name);
}

/// The radius that shortens nothing: that of the frame's longest motion.
inline const params::Json kLifted{{"max_radius_px", 0}};

/// Tile size of a preset of preset_of(method, ...) at an image height and a longest motion of half the exposure. 0 for
/// a method without tiles.
inline int tile_px(const BlurMethod& method, const preset::Preset& preset, int height, double longest_px) {
  if (!method.has_clamp) return method.tile_px;
  const params::Json stage = preset::to_json(preset).at("stages").at(0);
  double radius = stage.at("max_radius_px").get<double>() * height / stage.at("reference_height_px").get<double>();
  if (radius == 0) radius = longest_px;
  return std::max(1, static_cast<int>(std::ceil(radius)));
}

/// What one frame is measured against.
struct BlurTruth {
  std::array<Plane, 3> sharp, truth;  ///< red, green and blue
  Plane uncovered;                    ///< see disocclusion.h
  double longest_px;                  ///< way of a surface during half the exposure
};
inline metrics::Rgb rgb_of(const std::array<Plane, 3>& planes) { return {planes[0], planes[1], planes[2]}; }

/// A sequence with truth for some of its frames.
struct BlurCase {
  std::string name, channels;  ///< prefix of the beauty's channels
  std::unique_ptr<FrameSource> source;
  std::vector<int> on_disk;
  std::map<int, BlurTruth> frames;
  int height = 0;
  int seam_runs = 1;  ///< with the tiles laid elsewhere in each: seams that are content's average out
};

inline std::array<Plane, 3> first_three(std::vector<Plane>& planes) {
  return {std::move(planes.at(0)), std::move(planes.at(1)), std::move(planes.at(2))};
}

/// The longest way of a surface during half the exposure.
inline double longest_half_exposure_px(const Frame& frame) {
  const auto& prev = frame.planes(Role::velocity_prev);
  const auto& next = frame.planes(Role::velocity_next);
  double longest = 0;
  for (int y = 0; y < frame.window.height(); ++y)
    for (int x = 0; x < frame.window.width(); ++x) {
      const auto half = [&](size_t c) {
        return kShutter_frames / 4 * static_cast<double>(next[c](x, y) - prev[c](x, y));
      };
      const double length = std::hypot(half(0), half(1));
      if (std::isfinite(length)) longest = std::max(longest, length);
    }
  return longest;
}
/// Adds a frame; the file's own mask of what is uncovered stands in where `uncovered` is empty.
inline void add_frame(BlurCase& blur, Frame frame, std::array<Plane, 3> truth, Plane uncovered) {
  blur.height = frame.display.height();
  const double longest_px = longest_half_exposure_px(frame);
  if (uncovered.empty()) uncovered = disocclusion_of(frame, kShutter_frames, kShutterSamples);
  blur.frames[frame.number] = {first_three(frame.layers.at(0).planes), std::move(truth), std::move(uncovered),
                               longest_px};
}

inline const RoleSet kVelocities{Role::velocity_prev, Role::velocity_next};

/// The public sequence, where it is there.
inline BlurCase yard_blur_case(const std::vector<int>& frames) {
  BlurCase blur;
  blur.name = "yard", blur.channels = "ViewLayer.Combined.";
  blur.source.reset(new io::FileSource(open_yard("yard")));  // which cannot be moved
  blur.on_disk = frames_from_to(1, kYardFrames);
  io::FileSource truth = open_yard("yard_blur");
  for (const int number : frames)
    add_frame(blur, *blur.source->load(number, "", kVelocities, true),
              first_three(truth.load(number, "", {}, true)->layers.at(0).planes), {});
  return blur;
}

/// Frame 4 of a scene, 240x135, among frames 1 to 8.
inline BlurCase scene_blur_case(const std::string& name) {
  constexpr int kFrame = 4;
  const RenderSettings settings{240, 135, 4};
  const Scene& scene = find_scene(name);
  BlurCase blur;
  blur.name = name;
  blur.source = std::make_unique<SceneSource>(scene, settings, 1, 8);
  blur.on_disk = frames_from_to(1, 8);
  std::vector<Plane> truth = cached_blur_truth(name, kFrame, kShutter_frames, kShutterSamples, settings);
  add_frame(blur, *blur.source->load(kFrame, "", kVelocities, true), first_three(truth),
            disocclusion_truth(scene, kFrame, kShutter_frames, kShutterSamples, settings.width, settings.height));
  return blur;
}

/// A sequence whose absolute coordinates are larger by `shift` pixels, so that tiles lie elsewhere in its pictures.
class ShiftedSource final : public FrameSource {
 public:
  ShiftedSource(FrameSource& source, int shift) : source_(source), shift_(shift) {}
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override {
    std::optional<Frame> frame = source_.load(number, view, roles, with_layers);
    if (!frame) return frame;
    frame->window = shifted(frame->window), frame->display = shifted(frame->display);
    if (frame->camera) frame->camera->cx += shift_, frame->camera->cy += shift_;
    for (Layer& layer : frame->layers) layer.data_window = shifted(layer.data_window);
    return frame;
  }

 private:
  Window shifted(Window w) const { return {w.min_x + shift_, w.min_y + shift_, w.max_x + shift_, w.max_y + shift_}; }
  FrameSource& source_;
  int shift_;
};

/// The measured frames blurred by a preset, from the whole sequence.
inline std::map<int, std::array<Plane, 3>> blurred(const BlurCase& blur, const preset::Preset& preset, int shift = 0) {
  std::vector<pipeline::ViewPipeline> views;
  views.emplace_back(preset, "", kFullOffer, pipeline::Outputs{});
  ShiftedSource source(*blur.source, shift);
  MemorySink sink;
  pipeline::RunOptions options;
  options.on_disk = blur.on_disk;
  for (const auto& frame : blur.frames) options.written.push_back(frame.first);
  pipeline::run(views, source, sink, options);
  std::map<int, std::array<Plane, 3>> out;
  for (auto& [number, planes] : sink.planes)
    for (size_t c = 0; c < 3; ++c) out[number][c] = std::move(planes.at(blur.channels + "RGB"[c]));
  return out;
}

struct BlurScore {
  double psnr = 0;            ///< dB, of display values (gamma 2.2, clipped to 0..1)
  double ssim = 0;            ///< of the mean of the three display values
  double hdr_flip = 0;        ///< mean, 67 pixels a degree
  double radiance = 0;        ///< mean of all values, over that of the truth
  double psnr_uncovered = 0;  ///< where the frame does not show what the shutter sees
  double seams = 0;  ///< error steps across tile borders over those inside, of display values; NaN without tiles
  double seams_elsewhere = 0;  ///< the greatest for tiles laid elsewhere: what the picture's content alone makes
};

/// Gamma 2.2, clipped.
inline Plane displayed(ConstPlaneView plane) {
  Plane out(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) out(x, y) = std::pow(std::clamp(plane(x, y), 0.0F, 1.0F), 1 / 2.2F);
  return out;
}
inline Plane mean_of_three(const std::array<Plane, 3>& planes) {
  Plane out(planes[0].width(), planes[0].height());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) out(x, y) = (planes[0](x, y) + planes[1](x, y) + planes[2](x, y)) / 3;
  return out;
}
inline double sum_of(const metrics::Rgb& rgb) {
  double sum = 0;
  for (ConstPlaneView plane : rgb)
    for (int y = 0; y < plane.height; ++y)
      for (int x = 0; x < plane.width; ++x) sum += std::isfinite(plane(x, y)) ? static_cast<double>(plane(x, y)) : 0;
  return sum;
}

inline std::array<Plane, 3> all_displayed(const metrics::Rgb& rgb) {
  return {displayed(rgb[0]), displayed(rgb[1]), displayed(rgb[2])};
}

/// Mean over the channels; tiles start at `first` along both axes.
inline double seam_ratio(const std::array<Plane, 3>& shown, const std::array<Plane, 3>& truth, int tile, int first) {
  double sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += metrics::tile_seam_ratio(shown[c], truth[c], tile, first, first) / 3;
  return sum;
}
/// The greatest for up to 16 other places of the tiles, along the diagonal.
inline double seam_ratio_elsewhere(const std::array<Plane, 3>& shown, const std::array<Plane, 3>& truth, int tile) {
  double greatest = std::nan("");
  const int step = (tile - 2) / 16 + 1;
  for (int first = step; first < tile; first += step)
    greatest = std::fmax(greatest, seam_ratio(shown, truth, tile, first));
  return greatest;
}

/// `tile` 0: the method has none.
inline BlurScore blur_score(const metrics::Rgb& image, const metrics::Rgb& truth, ConstPlaneView uncovered, int tile) {
  const std::array<Plane, 3> shown = all_displayed(image), true_shown = all_displayed(truth);
  const Plane flip = metrics::hdr_flip(image, truth);
  BlurScore score;
  score.psnr = metrics::display_psnr(image, truth);
  score.ssim = metrics::ssim(mean_of_three(shown), mean_of_three(true_shown));
  score.hdr_flip = metrics::distribution(std::array<ConstPlaneView, 1>{flip}).mean;
  score.radiance = sum_of(image) / sum_of(truth);
  score.psnr_uncovered = metrics::display_psnr(image, truth, uncovered);
  score.seams = tile > 0 ? seam_ratio(shown, true_shown, tile, 0) : std::nan("");
  score.seams_elsewhere = tile > 0 ? seam_ratio_elsewhere(shown, true_shown, tile) : std::nan("");
  return score;
}

/// Makes each frame's seam ratio the mean of blur.seam_runs runs with tiles at evenly spaced places.
inline void average_seams(const BlurCase& blur, const BlurMethod& method, const preset::Preset& preset,
                          std::map<int, BlurScore>& scores) {
  int largest = 0;
  for (const auto& [number, frame] : blur.frames)
    largest = std::max(largest, tile_px(method, preset, blur.height, frame.longest_px));
  if (largest == 0) return;
  std::map<int, double> sums;
  for (int run = 1; run < blur.seam_runs; ++run) {
    const int shift = largest * run / blur.seam_runs;
    for (const auto& [number, image] : blurred(blur, preset, shift)) {
      const BlurTruth& frame = blur.frames.at(number);
      const int tile = tile_px(method, preset, blur.height, frame.longest_px);
      sums[number] += seam_ratio(all_displayed(rgb_of(image)), all_displayed(rgb_of(frame.truth)), tile, -shift);
    }
  }
  for (auto& [number, score] : scores) score.seams = (score.seams + sums[number]) / blur.seam_runs;
}

/// Of every measured frame. `clamped` false lifts the radius of a method that has one.
inline std::map<int, BlurScore> blur_scores(const BlurCase& blur, const BlurMethod& method, bool clamped) {
  std::map<int, BlurScore> scores;
  if (!method.preset && !method.method) {
    for (const auto& [number, frame] : blur.frames)
      scores[number] = blur_score(rgb_of(frame.sharp), rgb_of(frame.truth), frame.uncovered, 0);
    return scores;
  }
  const preset::Preset preset = preset_of(method, clamped ? params::Json::object() : kLifted);
  for (const auto& [number, image] : blurred(blur, preset)) {
    const BlurTruth& frame = blur.frames.at(number);
    scores[number] = blur_score(rgb_of(image), rgb_of(frame.truth), frame.uncovered,
                                tile_px(method, preset, blur.height, frame.longest_px));
  }
  average_seams(blur, method, preset, scores);
  return scores;
}

}  // namespace aftershade::tests
