#include "core/report/worst_frames.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/parallel/rows.h"

namespace aftershade::report {

namespace {

void check(const Pixels& pixels, Window display) {
  const bool right_count = pixels.empty() || pixels.size() == 1 || pixels.size() == 3;
  if (!right_count || std::any_of(pixels.begin(), pixels.end(), [&](ConstPlaneView plane) {
        return plane.width != display.width() || plane.height != display.height();
      }))
    throw Error(ErrorCode::internal, "a picture of the report does not have the display window's size");
}

Pixels cropped(const Pixels& pixels, Window region) {
  Pixels out;
  for (const ConstPlaneView& plane : pixels)
    out.push_back({&plane(region.min_x, region.min_y), region.width(), region.height(), plane.stride});
  return out;
}

size_t bytes_of(const ShownFrame& frame) {
  size_t bytes = 0;
  for (const auto* pictures : {&frame.whole, &frame.detail})
    for (const Picture& picture : *pictures) bytes += picture.rgb.size();
  return bytes;
}

}  // namespace

WorstFrames::WorstFrames(Window display, ShowOptions options) : display_(display), options_(std::move(options)) {}

bool WorstFrames::is_wanted(double error, size_t bytes) const {
  if (kept_.empty()) return options_.max_frames > 0;
  const bool room = std::ssize(kept_) < options_.max_frames && (kept_.size() + 1) * bytes <= options_.max_bytes;
  return room || error > kept_.back().error;
}

ShownFrame WorstFrames::shown(int number, const FrameError& error, const std::vector<const Pixels*>& pictures) const {
  const Window region{error.region.min_x + display_.min_x, error.region.min_y + display_.min_y,
                      error.region.max_x + display_.min_x, error.region.max_y + display_.min_y};
  ShownFrame out{number, error.worst, region, {}, {}};
  const bool all_shown =
      region == display_ && display_.width() <= options_.whole_width_px && options_.pixel_aspect == 1.0F;
  out.whole.resize(pictures.size());
  if (!all_shown) out.detail.resize(pictures.size());
  for_rows(static_cast<int>(pictures.size()), [&](int index) {
    const auto i = static_cast<size_t>(index);
    const Pixels& pixels = *pictures[i];
    if (pixels.empty()) return;
    out.whole[i] = preview::display_picture(pixels, options_.display, {options_.whole_width_px, options_.pixel_aspect});
    if (!all_shown) out.detail[i] = preview::display_picture(cropped(pixels, error.region), options_.display);
  });
  return out;
}

void WorstFrames::offer(int number, const std::vector<Pixels>& candidates, const Pixels& reference,
                        const Pixels& input) {
  std::vector<const Pixels*> pictures;
  for (const Pixels& candidate : candidates) pictures.push_back(&candidate);
  if (options_.has_reference || !reference.empty()) pictures.push_back(&reference);
  pictures.push_back(&input);
  for (const Pixels* picture : pictures) check(*picture, display_);

  const FrameError error = frame_error(candidates, reference, input, options_.region_px);
  if (error.region.empty() || !is_wanted(error.worst, kept_.empty() ? 0 : bytes_of(kept_.front()))) return;
  ShownFrame frame = shown(number, error, pictures);
  const auto place =
      std::find_if(kept_.begin(), kept_.end(), [&](const ShownFrame& other) { return other.error < frame.error; });
  const size_t bytes = bytes_of(frame);
  kept_.insert(place, std::move(frame));
  while (kept_.size() > 1 && (std::ssize(kept_) > options_.max_frames || kept_.size() * bytes > options_.max_bytes))
    kept_.pop_back();
}

std::vector<ShownFrame> WorstFrames::take() {
  std::vector<ShownFrame> out = std::move(kept_);
  kept_.clear();
  std::sort(out.begin(), out.end(), [](const ShownFrame& a, const ShownFrame& b) { return a.number < b.number; });
  return out;
}

}  // namespace aftershade::report
