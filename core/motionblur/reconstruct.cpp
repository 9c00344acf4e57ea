#include "core/motionblur/reconstruct.h"

#include <algorithm>
#include <cmath>

#include "core/motionblur/light_change.h"
#include "core/motionblur/slice_tile.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

const params::Table& ReconstructParams::table() {
  using P = ReconstructParams;
  static const params::Table table = [] {
    params::TableBuilder<P> builder;
    return add_path(builder)
        .add("slices_per_px", &P::slices_per_px, {0.1, 16},
             "Times of the exposure at which the picture is assembled, for each pixel of the longest way nearby.")
        .add("least_slices", &P::least_slices, {2, 1024}, "At least so many times, wherever anything moves.")
        .add("most_slices", &P::most_slices, {2, 4096}, "At most so many times.")
        .add(
            "neighbours", &P::neighbours, {0, 8},
            "Frames to each side that show what the frame itself does not; beyond the first, of standing surfaces only "
            "(needs the camera's position).")
        .add("changing_light", &P::changing_light,
             "Let the light on a surface change evenly towards what it is in the frames beside, so that moving shadows "
             "blur.")
        .build();
  }();
  return table;
}

namespace {

constexpr int kTile = SliceTile::kSize;

/// The pixels that a point may touch while the shutter is open.
Window touched(const SurfacePoint& p, Path path, Shutter shutter) {
  float low_x = p.x, high_x = p.x, low_y = p.y, high_y = p.y;
  const auto visit = [&](float t) {
    if (t < shutter.opens || t > shutter.closes) return;
    const float x = p.x + displacement(path, p.prev_x, p.next_x, t),
                y = p.y + displacement(path, p.prev_y, p.next_y, t);
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  };
  const auto turn = [](float prev, float next) {  // where the parabola turns
    return next + prev != 0 ? 0.5F * (prev - next) / (next + prev) : 0.0F;
  };
  for (const float t : {shutter.opens, shutter.closes, turn(p.prev_x, p.next_x), turn(p.prev_y, p.next_y)}) visit(t);
  constexpr float kReach = 1.5F;  // half a box, half a pixel, and half of what a surface may stretch
  const auto whole = [](float v) { return static_cast<int>(std::clamp(v, -1e6F, 1e6F)); };
  return {whole(std::floor(low_x - kReach)), whole(std::floor(low_y - kReach)), whole(std::ceil(high_x + kReach)),
          whole(std::ceil(high_y + kReach))};
}

/// The tiles of a window and the points that may touch each, in the order of their numbers.
class Tiles {
 public:
  Tiles(const SliceScene& scene, Window window)
      : window_(window),
        first_x_(-(window.min_x & (kTile - 1))),
        first_y_(-(window.min_y & (kTile - 1))),
        columns_((window.width() - first_x_ + kTile - 1) / kTile),
        rows_((window.height() - first_y_ + kTile - 1) / kTile),
        members_(static_cast<size_t>(columns_ * rows_)),
        longest_px_(members_.size()) {
    for (size_t i = 0; i < scene.points.size(); ++i) add(scene, static_cast<int>(i));
  }
  int count() const { return columns_ * rows_; }
  Window pixels(int tile) const {
    const int x = first_x_ + tile % columns_ * kTile, y = first_y_ + tile / columns_ * kTile;
    return {std::max(x, 0), std::max(y, 0), std::min(x + kTile, window_.width()) - 1,
            std::min(y + kTile, window_.height()) - 1};
  }
  const std::vector<int>& members(int tile) const { return members_[static_cast<size_t>(tile)]; }
  float longest_px(int tile) const { return longest_px_[static_cast<size_t>(tile)]; }  ///< 0: nothing moves

 private:
  void add(const SliceScene& scene, int number) {
    const SurfacePoint& p = scene.points[static_cast<size_t>(number)];
    const Window w = touched(p, scene.path, scene.shutter);
    const bool moving = p.frame > 0 || moves(p, scene.path, scene.shutter);
    const float way = moving ? static_cast<float>(std::max(w.width(), w.height())) : 0.0F;
    const Window inside = intersection(w, {0, 0, window_.width() - 1, window_.height() - 1});
    if (inside.width() <= 0 || inside.height() <= 0) return;
    for (int row = (inside.min_y - first_y_) / kTile; row <= (inside.max_y - first_y_) / kTile; ++row)
      for (int column = (inside.min_x - first_x_) / kTile; column <= (inside.max_x - first_x_) / kTile; ++column) {
        const auto tile = static_cast<size_t>(row * columns_ + column);
        members_[tile].push_back(number);
        longest_px_[tile] = std::max(longest_px_[tile], way);
      }
  }

  Window window_;
  int first_x_, first_y_;  ///< of tile 0; tiles are tied to absolute coordinates
  int columns_, rows_;
  std::vector<std::vector<int>> members_;
  std::vector<float> longest_px_;
};

/// What the tiles leave for those pixels that no frame saw: the farthest surface of every pixel.
struct Behind {
  std::vector<Plane> channels;  ///< valid where farthest > 0
  Plane nearest, farthest;      ///< depth of the surfaces seen; 0: none
};

void finish_tile(const SliceTile& tile, Window pixels, int slices, const SequenceFrame& frame, Reconstruction& out,
                 Behind& behind) {
  const auto whole = static_cast<float>(slices);
  for (int y = pixels.min_y; y <= pixels.max_y; ++y)
    for (int x = pixels.min_x; x <= pixels.max_x; ++x) {
      const int i = x - pixels.min_x, j = y - pixels.min_y;
      const SliceTile::Pixel& pixel = tile.pixel(i, j);
      const bool finite = std::all_of(frame.channels.begin(), frame.channels.end(),
                                      [&](ConstPlaneView plane) { return std::abs(plane(x, y)) < 1e30F; });
      const bool left = pixel.seen < whole;  // its surface has, and nothing took the place
      if ((!pixel.crossed && !left) || !finite) continue;
      behind.nearest(x, y) = pixel.behind > 0 ? pixel.nearest : 0.0F;
      behind.farthest(x, y) = pixel.behind > 0 ? pixel.farthest : 0.0F;
      out.guessed(x, y) = std::max(1 - pixel.seen / whole, 0.0F);
      for (size_t c = 0; c < out.channels.size(); ++c) {
        const float centre = frame.channels[c](x, y);
        out.channels[c](x, y) = centre + tile.colour(i, j)[c] / whole;
        if (pixel.behind > 0) behind.channels[c](x, y) = centre + tile.behind(i, j)[c] / pixel.behind;
      }
    }
}

/// A guess for pixel (x, y): its own farthest surface, or, if that is the only one it shows, the mean of the nearest
/// pixels' farther ones, by the inverse fourth power of the distance.
class Guess {
 public:
  Guess(const SequenceFrame& frame, const Behind& behind)
      : frame_(frame), behind_(behind), sum_(behind.channels.size()) {}

  /// Less the frame's own colour there, so that equal colours stay to the bit.
  const std::vector<float>& operator()(int x, int y) {
    x_ = x, y_ = y;
    const float front = behind_.nearest(x, y);
    std::fill(sum_.begin(), sum_.end(), 0.0F);
    weight_ = 0;
    float best = 1e30F;
    if (!lies_behind(x, y, front))
      for (int ring = 1; ring <= kSearch_px && static_cast<float>(ring * ring) <= 1.5F * best; ++ring)
        for (int j = y - ring; j <= y + ring; ++j)
          for (int i = x - ring; i <= x + ring; i += std::abs(j - y) == ring ? 1 : 2 * ring) {
            if (!lies_behind(i, j, front)) continue;
            const auto square = static_cast<float>((i - x) * (i - x) + (j - y) * (j - y));
            best = std::min(best, square);
            add(i, j, 1 / (square * square));
          }
    if (weight_ == 0 && behind_.farthest(x, y) > 0) add(x, y, 1);
    for (float& value : sum_) value /= std::max(weight_, 1e-30F);
    return sum_;
  }

 private:
  static constexpr int kSearch_px = 128;
  static constexpr float kFarther = 1.05F;

  bool lies_behind(int x, int y, float front) const {
    return x >= 0 && y >= 0 && x < behind_.farthest.width() && y < behind_.farthest.height() &&
           behind_.farthest(x, y) > front * kFarther;
  }
  void add(int x, int y, float weight) {
    weight_ += weight;
    for (size_t c = 0; c < sum_.size(); ++c)
      sum_[c] += weight * (behind_.channels[c](x, y) - frame_.channels[c](x_, y_));
  }

  const SequenceFrame& frame_;
  const Behind& behind_;
  std::vector<float> sum_;
  float weight_ = 0;
  int x_ = 0, y_ = 0;
};

void fill_guessed(const SequenceFrame& frame, const Behind& behind, Reconstruction& out) {
  for_rows(out.guessed.height(), [&](int y) {
    Guess guess(frame, behind);
    for (int x = 0; x < out.guessed.width(); ++x) {
      if (out.guessed(x, y) <= 0) continue;
      const std::vector<float>& colour = guess(x, y);
      for (size_t c = 0; c < colour.size(); ++c) out.channels[c](x, y) += out.guessed(x, y) * colour[c];
    }
  });
}

Behind behind_of(const SequenceFrame& frame) {
  const int width = frame.window.width(), height = frame.window.height();
  Behind behind{{}, Plane(width, height), Plane(width, height)};
  for (const ConstPlaneView& plane : frame.channels) behind.channels.push_back(copy_of(plane));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) behind.nearest(x, y) = behind.farthest(x, y) = finite_depth(frame.depth, x, y);
  return behind;
}

const SequenceFrame* beside(const std::vector<SequenceFrame>& sequence, int step) {
  for (const SequenceFrame& frame : sequence)
    if (frame.number == sequence.front().number + step) return &frame;
  return nullptr;
}

}  // namespace

Reconstruction reconstruct(const ReconstructParams& params, const std::vector<SequenceFrame>& sequence,
                           Shutter shutter) {
  const SequenceFrame& frame = sequence.front();
  Reconstruction out{{}, Plane(frame.window.width(), frame.window.height())};
  for (const ConstPlaneView& plane : frame.channels) out.channels.push_back(copy_of(plane));
  std::vector<Plane> before, after;
  if (params.changing_light)
    for (const int step : {-1, 1})
      if (const SequenceFrame* neighbour = beside(sequence, step))
        (step < 0 ? before : after) = channels_in(frame, *neighbour, step);
  SliceScene scene{&sequence, before.empty() ? nullptr : &before, after.empty() ? nullptr : &after, {}, params.path,
                   shutter};
  add_points(frame, shutter, scene.points);
  for (size_t i = 1; i < sequence.size(); ++i) add_hidden_points(sequence, i, shutter, scene.points);
  const Tiles tiles(scene, frame.window);
  Behind behind = behind_of(frame);
  for_rows(tiles.count(), [&](int i) {
    if (tiles.longest_px(i) == 0) return;
    const Window pixels = tiles.pixels(i);
    SliceTile tile(scene, pixels.min_x, pixels.min_y, pixels.width(), pixels.height());
    const int slices = std::clamp(static_cast<int>(params.slices_per_px * tiles.longest_px(i)), params.least_slices,
                                  std::max(params.least_slices, params.most_slices));
    for (int s = 0; s < slices; ++s) {
      const float share = (static_cast<float>(s) + 0.5F) / static_cast<float>(slices);
      tile.add_slice(tiles.members(i), shutter.opens + share * shutter.length());
    }
    finish_tile(tile, pixels, slices, frame, out, behind);
  });
  fill_guessed(frame, behind, out);
  return out;
}

}  // namespace aftershade::motionblur
