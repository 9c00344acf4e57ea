#pragma once
#include <algorithm>
#include <functional>
#include <vector>

#include "core/metrics/instant.h"
#include "core/metrics/sequence_scores.h"

/// A block that slides over a wall, seen by a camera that stands still, for scores whose values can be worked out.
namespace aftershade::metrics {

/// Frames, pixels and what is where: the block is 4 px ahead every frame, the railing one pixel wide.
struct SlidingBlock {
  static constexpr int kWidth = 120, kHeight = 48, kFrames = 14, kStep_px = 4;
  static constexpr int kTop = 16, kBottom = 31, kBlock_px = 16, kRailing = 110;
  static constexpr int kMargin_px = kHeight / kBorderShare;

  static int left(int frame) { return 8 + kStep_px * frame; }
  static bool block(int frame, int x, int y) {
    return x >= left(frame) && x < left(frame) + kBlock_px && y >= kTop && y <= kBottom;
  }
  /// In the block or within the margin around it.
  static bool footprint(int frame, int x, int y) {
    return x >= left(frame) - kMargin_px && x < left(frame) + kBlock_px + kMargin_px && y >= kTop - kMargin_px &&
           y <= kBottom + kMargin_px;
  }
  /// Frames since the pixel was in the block (or its footprint) for the last time; 0: now, -1: never since frame 1.
  static int since(int frame, int x, int y, bool (*inside)(int, int, int)) {
    for (int back = 0; frame - back >= 1; ++back)
      if (inside(frame - back, x, y)) return back;
    return -1;
  }
  /// The first frame has no past, so what the block hid in frame 0 comes into sight in frame 1.
  static int since_hidden(int frame, int x, int y) {
    for (int back = 0; frame - back >= 0; ++back)
      if (block(frame - back, x, y)) return back;
    return -1;
  }
};

using Value = std::function<double(int frame, int x, int y)>;
inline double open(int, int, int) { return 1; }

/// One frame of it with planes of its own.
struct BlockFrame {
  Plane ao, truth, depth, velocity_x, velocity_y;
  int number;
  BlockFrame(int frame, const Value& ao_at, const Value& truth_at) : number(frame) {
    using S = SlidingBlock;
    for (Plane* plane : {&ao, &truth, &depth, &velocity_x, &velocity_y}) *plane = Plane(S::kWidth, S::kHeight);
    for (int y = 0; y < S::kHeight; ++y)
      for (int x = 0; x < S::kWidth; ++x) {
        ao(x, y) = static_cast<float>(ao_at(frame, x, y));
        truth(x, y) = static_cast<float>(truth_at(frame, x, y));
        depth(x, y) = S::block(frame, x, y) ? 2.0F : x == S::kRailing ? 3.0F : 4.0F;
        velocity_x(x, y) = S::block(frame, x, y) ? -static_cast<float>(S::kStep_px) : 0.0F;
      }
  }
  ScoredFrame scored(bool with_camera = true) const {
    ScoredFrame out;
    out.number = number;
    out.ao = ao;
    out.true_ao = truth;
    out.color = {ao, ao, ao};
    out.true_color = {truth, truth, truth};
    out.depth = depth;
    out.velocity_x = velocity_x;
    out.velocity_y = velocity_y;
    if (with_camera) {
      out.camera.emplace();
      out.camera->world_to_camera = Mat4();
    }
    return out;
  }
};

/// The scores of all its frames together.
inline Scores score_block(const std::vector<std::string>& names, const Value& ao, const Value& truth = open,
                          bool with_camera = true) {
  SequenceScorer scorer(names);
  for (int frame = 0; frame < SlidingBlock::kFrames; ++frame)
    scorer.add(BlockFrame(frame, ao, truth).scored(with_camera));
  return scorer.sequence();
}

}  // namespace aftershade::metrics
