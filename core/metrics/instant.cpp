#include "core/metrics/instant.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel/rows.h"

namespace aftershade::metrics {

namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFaint = 0.01;

bool is_surface(float depth) { return depth > 0 && std::isfinite(depth); }
bool counts(ConstPlaneView mask, int x, int y) { return mask.empty() || mask(x, y) > 0.5F; }
size_t index(Signal signal) { return static_cast<size_t>(signal); }

/// 1 where value(x, y).
template <class Value>
Plane mask_of(int width, int height, Value&& value) {
  Plane out(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) out(x, y) = value(x, y) ? 1.0F : 0.0F;
  });
  return out;
}

bool has_position(const std::optional<Camera>& camera) { return camera && camera->world_to_camera; }
}  // namespace

Instant::Instant(const ScoredFrame& frame, const History* before) : frame_(frame), before_(before) {}

bool Instant::has(const MetricInfo& metric) const {
  const bool image = metric.of_ao ? !frame_.ao.empty() : !frame_.color[0].empty();
  const bool truth = metric.of_ao ? !frame_.true_ao.empty() : !frame_.true_color[0].empty();
  if (!image || (metric.reference && !truth)) return false;
  if (!metric.temporal) return true;
  const Signal signal = metric.of_ao ? Signal::ao : Signal::color;
  if (!before_ || frame_.depth.empty() || before_->depth.empty() || before(signal).empty()) return false;
  const bool cameras = has_position(frame_.camera) && has_position(before_->camera);
  const bool vectors = !frame_.velocity_x.empty();
  return metric.moving ? cameras && vectors : cameras || vectors;
}

const Displayed& Instant::shown() {
  if (!shown_) shown_ = displayed(frame_.color, frame_.true_color, frame_.mask);
  return *shown_;
}

const ErrorSums& Instant::color_errors() {
  if (!color_errors_) {
    color_errors_.emplace();
    for (size_t c = 0; c < 3; ++c) *color_errors_ += error_sums(frame_.color[c], frame_.true_color[c], frame_.mask);
  }
  return *color_errors_;
}

const ErrorSums& Instant::ao_errors() {
  if (!ao_errors_) ao_errors_ = error_sums(frame_.ao, frame_.true_ao, mask(Signal::ao));
  return *ao_errors_;
}

ConstPlaneView Instant::image(Signal signal) { return signal == Signal::ao ? frame_.ao : shown().luma_a.view(); }
ConstPlaneView Instant::truth(Signal signal) {
  if (signal == Signal::ao) return frame_.true_ao;
  return frame_.true_color[0].empty() ? ConstPlaneView{} : shown().luma_b.view();
}

ConstPlaneView Instant::mask(Signal signal) {
  if (signal == Signal::color || frame_.depth.empty()) return frame_.mask;
  if (surfaces_.empty())
    surfaces_ = mask_of(frame_.depth.width, frame_.depth.height,
                        [&](int x, int y) { return is_surface(frame_.depth(x, y)) && counts(frame_.mask, x, y); });
  return surfaces_;
}

const Past& Instant::past() {
  if (!past_) {
    PastInput input{frame_.depth, before_->depth,  frame_.velocity_x, frame_.velocity_y,
                    {},           frame_.origin_x, frame_.origin_y};
    if (frame_.camera && before_->camera) input.camera = CameraReprojection::create(*frame_.camera, *before_->camera);
    past_ = past_of(input);
  }
  return *past_;
}

ConstPlaneView Instant::before(Signal signal) const { return before_->image[index(signal)]; }

const Plane& Instant::flicker(Signal signal) {
  Plane& plane = flicker_[signal];
  if (!plane.empty()) return plane;
  const Motion motion = past().motion();
  const ConstPlaneView now = image(signal), true_now = truth(signal), true_before = before_->truth[index(signal)];
  Plane true_change(now.width, now.height);
  if (!true_now.empty() && !true_before.empty()) true_change = change_along(true_now, true_before, motion);
  return plane = flicker_above_truth(now, before(signal), true_change, motion);
}

void Instant::split_by_stability() {
  const Plane thin = unstable_pixels(frame_.depth);
  const ConstPlaneView surfaces = mask(Signal::ao);
  stable_ =
      mask_of(thin.width(), thin.height(), [&](int x, int y) { return surfaces(x, y) > 0.5F && !(thin(x, y) > 0.5F); });
  unstable_ =
      mask_of(thin.width(), thin.height(), [&](int x, int y) { return surfaces(x, y) > 0.5F && thin(x, y) > 0.5F; });
}
ConstPlaneView Instant::stable() {
  if (stable_.empty()) split_by_stability();
  return stable_;
}
ConstPlaneView Instant::unstable() {
  if (unstable_.empty()) split_by_stability();
  return unstable_;
}

std::vector<AgeError> Instant::errors_since(const Plane& since, int first_age, Signal signal) {
  constexpr float kSettled = kFadingFrames + 1;
  const ConstPlaneView surfaces = mask(Signal::ao);
  Plane ages(since.width(), since.height());
  for_rows(since.height(), [&](int y) {
    for (int x = 0; x < since.width(); ++x) {
      const float age = since(x, y) + static_cast<float>(first_age);  // NaN: unknown
      ages(x, y) = surfaces(x, y) > 0.5F && age >= 1 ? std::min(age, kSettled) : 0;
    }
  });
  const ConstPlaneView image_of[] = {image(signal)}, truth_of[] = {truth(signal)}, age_of[] = {ages};
  return error_by_age(image_of, truth_of, age_of, kFadingFrames + 1);
}

const std::vector<AgeError>& Instant::since_disoccluded(Signal signal) {
  if (since_disoccluded_.empty())
    since_disoccluded_ = frames_since(disoccluded(past()), before_->since_disoccluded, past());
  std::vector<AgeError>& errors = disoccluded_errors_[signal];
  if (errors.empty()) errors = errors_since(since_disoccluded_, 1, signal);
  return errors;
}

const std::vector<AgeError>& Instant::since_left(Signal signal) {
  if (since_footprint_.empty())
    since_footprint_ =
        frames_since(moving_footprint(past(), border_px(frame_.depth.height)), before_->since_footprint, past());
  std::vector<AgeError>& errors = left_errors_[signal];
  if (errors.empty()) errors = errors_since(since_footprint_, 0, signal);
  return errors;
}

std::unique_ptr<History> Instant::history(bool color, bool ao) {
  auto out = std::make_unique<History>();
  out->number = frame_.number;
  for (const auto& [signal, asked, there] :
       {std::tuple(Signal::color, color, !frame_.color[0].empty()), std::tuple(Signal::ao, ao, !frame_.ao.empty())}) {
    if (!asked || !there) continue;
    out->image[index(signal)] = copy_of(image(signal));
    if (!truth(signal).empty()) out->truth[index(signal)] = copy_of(truth(signal));
  }
  if ((color || ao) && !frame_.depth.empty()) out->depth = copy_of(frame_.depth);
  out->camera = frame_.camera;
  out->since_disoccluded = std::move(since_disoccluded_);
  out->since_footprint = std::move(since_footprint_);
  return out;
}

TileSeams& TileSeams::operator+=(const TileSeams& other) {
  for (size_t i = 0; i < of_size.size(); ++i) of_size[i] += other.of_size[i];
  return *this;
}
double TileSeams::greatest() const {
  double most = kNan;
  for (const SeamSums& sums : of_size) {
    const bool even = sums.across.mean() <= 0 && sums.inside.mean() <= 0;
    most = std::fmax(most, even ? 1 : sums.across.mean() / sums.inside.mean());
  }
  return most;
}
TileSeams tile_seams(Instant& instant, Signal signal) {
  TileSeams out;
  const ScoredFrame& frame = instant.frame();
  for (size_t i = 0; i < kTiles_px.size(); ++i)
    out.of_size[i] = tile_seam_sums(instant.image(signal), instant.truth(signal), kTiles_px[i], -frame.origin_x,
                                    -frame.origin_y, instant.mask(signal));
  return out;
}

BorderErrors& BorderErrors::operator+=(const BorderErrors& other) {
  border += other.border;
  inside += other.inside;
  return *this;
}
double BorderErrors::excess() const { return border.mean_absolute() - inside.mean_absolute(); }
BorderErrors border_errors(Instant& instant, Signal signal) {
  const ConstPlaneView image = instant.image(signal), truth = instant.truth(signal), mask = instant.mask(signal);
  const int reach = border_px(image.height);
  const auto in_border = [&](int x, int y) {
    return std::min({x, y, image.width - 1 - x, image.height - 1 - y}) < reach;
  };
  const auto part = [&](bool border) {
    return mask_of(image.width, image.height,
                   [&](int x, int y) { return in_border(x, y) == border && counts(mask, x, y); });
  };
  return {error_sums(image, truth, part(true)), error_sums(image, truth, part(false))};
}

Fading& Fading::operator+=(const Fading& other) {
  if (by_age.empty()) by_age.resize(other.by_age.size());
  for (size_t k = 0; k < std::min(by_age.size(), other.by_age.size()); ++k) {
    const AgeError both[] = {by_age[k], other.by_age[k]};
    by_age[k] = total_error(both);
  }
  return *this;
}
AgeError Fading::fresh() const { return total_error({by_age.data(), by_age.empty() ? 0 : by_age.size() - 1}); }
double Fading::half_life(bool absolute) const {
  if (by_age.size() < 2) return kNan;
  const auto value = [&](const AgeError& error) { return absolute ? error.absolute : error.mean; };
  std::vector<double> excess;
  for (size_t k = 0; k + 1 < by_age.size(); ++k) excess.push_back(value(by_age[k]) - value(by_age.back()));
  const double first = absolute ? excess[0] : std::abs(excess[0]);
  return first < kFaint ? 0 : half_life_frames(excess);
}

}  // namespace aftershade::metrics
