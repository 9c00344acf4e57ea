#pragma once
#include "core/ao/estimator.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/params/table.h"

namespace aftershade::ao {

enum class SphereVolume { hemisphere, sphere };

/// The sphere kernel and how it is judged, shared by all methods that sample it (algorithms 8). Points s of a ball
/// around the pixel's point p are tested against the depth buffer: one that lies behind the surface seen there is
/// hidden.
///   hemisphere (StarCraft II: Filion and McNaughton, "Effects & Techniques", SIGGRAPH 2008): points below the surface
///     are mirrored through p; a hidden point counts smoothstep(R / |z_p - z|), so that what is far in front fades;
///     only what rises more than bias * R above the tangent plane of p occludes. Visibility = 1 - mean: 1 on a plane,
///     and the open share of the half ball (volumetric obscurance) where everything near is seen.
///   sphere (Crysis: Mittring, "Finding Next Gen", SIGGRAPH 2007): no normals and no bias; by sat((z_p - z) / z) a
///     point counts as half hidden, and visibility = sat(a^2 + a) of the mean a, 0.75 on a plane. Its offsets are
///     metres here, not shares of the screen.
/// Points outside the image or behind the camera are left out of the mean; sky is behind everything.
struct SphereSamples {
  SphereVolume volume = SphereVolume::hemisphere;
  int samples = 16;
  float radius_m = 1.0F;  ///< ours: sources give none in metres
  float bias = 0.01F;     ///< ours
  bool dither = true;
  NormalSource normals = NormalSource::automatic;
  bool operator==(const SphereSamples&) const = default;
};

/// Sphere-kernel SSAO by itself (Crysis / StarCraft II lineage).
struct SphereKernelParams : SphereSamples {
  static constexpr std::string_view method = "sphere-kernel";
  static constexpr std::string_view summary = "sphere-kernel SSAO (Crysis, StarCraft II)";
  Resolution resolution = Resolution::half;
  bool per_frame_noise = false;
  static const params::Table& table();
  bool operator==(const SphereKernelParams&) const = default;
};

/// The records of SphereSamples, for the tables of all methods that have it as base.
template <class P>
params::TableBuilder<P>& add_sphere_samples(params::TableBuilder<P>& table) {
  return table
      .add("volume", static_cast<SphereVolume P::*>(&P::volume), {"hemisphere", "sphere"},
           "Test points above the surface only, or, literally as in Crysis, all around, which leaves a plane at 0.75.")
      .add("samples", &P::samples, {1, 1024}, "Points tested per pixel and frame.")
      .add("radius_m", &P::radius_m, {1e-6, 1e6}, "Radius of the ball that the points fill.")
      .add("bias", &P::bias, {1e-4, 1},
           "Height above the tangent plane, as a share of the radius, up to which a surface does not occlude, against "
           "self-occlusion; the whole sphere has none.")
      .add("dither", &P::dither, "Mirror the points in another direction at each pixel of a 4x4 tile.")
      .add("normals", static_cast<NormalSource P::*>(&P::normals), {"auto", "file", "depth"},
           "Where normals come from: the file if it has them and else the depth, the file only, or the depth only.");
}

/// Which points of the endless sequence a texel tests: `count` of them from `first` on. Planes, one value a texel of
/// the grid (whole numbers; 0 <= first < 2^23), take the place of the numbers when they are there.
struct SampleRange {
  int first = 0, count = 0;
  ConstPlaneView first_at, count_at;
};

/// Where the points of frame `number` start when every frame takes the `count` that follow those of the frame before.
int first_of_frame(int number, int count);

/// Visibility (1 = open) at the grid's texels; 1 on background and where no point could be tested.
Plane sphere_kernel(const SphereSamples& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                    const SampleRange& range);

}  // namespace aftershade::ao
