#pragma once
#include <vector>

#include "core/motionblur/surface_points.h"

namespace aftershade::motionblur {

/// What every tile of a picture is made of.
struct SliceScene {
  const std::vector<SequenceFrame>* sequence;                   ///< index 0 is the frame itself
  const std::vector<Plane>*before = nullptr, *after = nullptr;  ///< the frame's channels in the light of f-1 and f+1
  std::vector<SurfacePoint> points;
  Path path;
  Shutter shutter;
};

/// One tile of the picture: slices of time are composited into it one after the other.
class SliceTile {
 public:
  static constexpr int kSize = 32;  ///< pixels, each way

  /// What a pixel has gathered. Colours are summed as differences from the pixel's own in f: where they agree the
  /// result is that to the bit (an alpha of 1 stays 1).
  struct Pixel {
    float seen = 0;      ///< slices in which something was there
    float farthest = 0;  ///< depth of the farthest surface seen, metres
    float nearest = 1e30F;
    float behind = 0;  ///< weight of `behind` colours: of surfaces about as far as the farthest
    bool crossed = false;
  };

  /// The tile's pixels are x0 .. x0 + width - 1, y0 .. y0 + height - 1 of the frame's window.
  SliceTile(const SliceScene& scene, int x0, int y0, int width, int height);

  /// Composites what the points numbered `members` show at time t.
  void add_slice(const std::vector<int>& members, float t);

  const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }  ///< x, y counted from the tile's corner
  const float* colour(int x, int y) const { return &colours_[index(x, y) * channels_]; }  ///< sum over slices seen
  const float* behind(int x, int y) const { return &behind_[index(x, y) * channels_]; }   ///< sum of weights

 private:
  struct Fragment {
    float depth, coverage;
    int point;
  };
  size_t index(int x, int y) const { return static_cast<size_t>(y * width_ + x); }
  void splat(int member, float t);
  void sort_by_pixel();
  void composite(size_t pixel, Fragment* first, Fragment* last, float t);
  void add_surface(size_t pixel, const Fragment* first, const Fragment* last, float alpha, float t);

  const SliceScene& scene_;
  int x0_, y0_, width_, height_;
  size_t channels_;
  std::vector<Pixel> pixels_;
  std::vector<float> colours_, behind_, centre_, surface_, slice_;
  struct Placed {
    int pixel;
    Fragment fragment;
  };
  std::vector<Placed> placed_;
  std::vector<Fragment> sorted_;
  std::vector<size_t> starts_;
};

/// Does the point leave its place by more than a hundredth of a pixel while the shutter is open?
bool moves(const SurfacePoint& point, Path path, Shutter shutter);

}  // namespace aftershade::motionblur
