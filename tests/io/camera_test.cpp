#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/io/camera_attributes.h"

namespace aftershade::io {
namespace {

struct Shot {
  Camera camera;
  Window display;
};

class Random {
 public:
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

 private:
  std::mt19937 engine_{7};
};

Mat4 diagonal(double x, double y, double z, double w = 1) {
  Mat4 m;
  m[0][0] = x, m[1][1] = y, m[2][2] = z, m[3][3] = w;
  return m;
}

/// A right-handed world (metres) to a canonical camera: a rotation, a move, and +Z turned forward.
Mat4 random_view(Random& random) {
  Mat4 rotation;
  rotation.setEulerAngles(Vec3(random(-3, 3), random(-3, 3), random(-3, 3)));
  Mat4 move;
  move.setTranslation(Vec3(random(-20, 20), random(-20, 20), random(-20, 20)));
  return rotation * move * diagonal(1, 1, -1);
}

Shot random_shot(Random& random, bool orthographic) {
  Shot s;
  s.display = {static_cast<int>(random(-50, 50)), static_cast<int>(random(-50, 50)), 0, 0};
  s.display.max_x = s.display.min_x + static_cast<int>(random(200, 2000));
  s.display.max_y = s.display.min_y + static_cast<int>(random(200, 2000));
  s.camera.orthographic = orthographic;
  s.camera.world_to_camera = random_view(random);
  s.camera.fx = s.display.width() * (orthographic ? random(0.02, 0.2) : random(0.4, 4));
  s.camera.fy = s.camera.fx * random(0.5, 2);
  s.camera.cx = s.display.min_x + s.display.width() * random(0.38, 0.62);
  s.camera.cy = s.display.min_y + s.display.height() * random(0.38, 0.62);
  return s;
}

/// Canonical camera space to standard NDC: 0..1, y down, w = z. The depth column is whatever a producer likes.
Mat4 standard_projection(const Shot& s, Random& random) {
  const double w = s.display.width(), h = s.display.height();
  Mat4 p = diagonal(s.camera.fx / w, -s.camera.fy / h, random(-2, 2), 0);
  const double cx = (s.camera.cx - s.display.min_x) / w, cy = (s.camera.cy - s.display.min_y) / h;
  const int row = s.camera.orthographic ? 3 : 2;
  p[row][0] = cx, p[row][1] = cy, p[row][3] = 1;
  if (s.camera.orthographic) p[2][3] = 0;
  p[3][2] = random(-2, 2);
  return p;
}

/// NDC 0..1 y down to other ranges, for row vectors on homogeneous coordinates.
Mat4 ndc_change(double sx, double ox, double sy, double oy) {
  Mat4 m = diagonal(sx, sy, 1);
  m[3][0] = ox, m[3][1] = oy;
  return m;
}
const Mat4 kSymmetricYUp = ndc_change(2, -1, -2, 1);
const Mat4 kUnitYUp = ndc_change(1, 0, -1, 1);

struct Pair {
  Mat4 view, ndc;
};
using Producer = std::function<Pair(const Shot&, Random&)>;

Pair standard(const Shot& s, Random& r) {
  return {*s.camera.world_to_camera, *s.camera.world_to_camera * standard_projection(s, r)};
}
Pair symmetric(const Shot& s, Random& r) { return {*s.camera.world_to_camera, standard(s, r).ndc * kSymmetricYUp}; }
Pair mantra(const Shot& s, Random& r) {
  return {*s.camera.world_to_camera, symmetric(s, r).ndc * diagonal(1, 1, 1, -1)};
}
Pair pbrt(const Shot& s, Random& r) {
  return {s.camera.world_to_camera->transposed(), (standard(s, r).ndc * kUnitYUp).transposed()};
}
Pair looks_along_minus_z(const Shot& s, Random& r) {
  return {*s.camera.world_to_camera * diagonal(1, 1, -1), symmetric(s, r).ndc};
}
Pair minus_z_standard_ndc(const Shot& s, Random& r) {
  return {*s.camera.world_to_camera * diagonal(1, 1, -1), standard(s, r).ndc};
}

/// Recovers the camera and compares the pictures of random points in front of it.
void expect_same_pictures(const char* name, const Producer& producer, bool orthographic, bool at_origin) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    Shot s = random_shot(random, orthographic);
    if (at_origin)
      for (int c = 0; c < 3; ++c) (*s.camera.world_to_camera)[3][c] = 0;
    const Pair pair = producer(s, random);
    const auto aspect = static_cast<float>(s.camera.fy / s.camera.fx);
    std::string note;
    const Camera found = normalize_camera(pair.view, pair.ndc, s.display, aspect, 1, &note);
    EXPECT_EQ(found.orthographic, orthographic) << name;
    EXPECT_EQ(note, "") << name;
    for (int j = 0; j < 20; ++j) {
      const Vec3 in_camera(random(-5, 5), random(-5, 5), random(1, 50));
      const Vec3 world = transform_point(in_camera, *inverse(*s.camera.world_to_camera));
      const Vec3 truth = s.camera.project(in_camera),
                 got = found.project(transform_point(world, *found.world_to_camera));
      ASSERT_NEAR(got.x, truth.x, 1e-6) << name << " camera " << i;
      ASSERT_NEAR(got.y, truth.y, 1e-6) << name << " camera " << i;
      ASSERT_NEAR(got.z, truth.z, 1e-9) << name << " camera " << i;
    }
  }
}

TEST(NormalizeCamera, EveryProducerGivesTheSamePictures) {
  struct Case {
    const char* name;
    Producer producer;
  };
  for (const Case& c :
       {Case{"standard", standard}, Case{"symmetric y up (Arnold, 3Delight)", symmetric},
        Case{"w = -z (Mantra)", mantra}, Case{"columns, y up (pbrt)", pbrt},
        Case{"-Z forward, symmetric", looks_along_minus_z}, Case{"-Z forward, standard NDC", minus_z_standard_ndc}})
    for (const bool at_origin : {false, true}) expect_same_pictures(c.name, c.producer, false, at_origin);
}

TEST(NormalizeCamera, Orthographic) {
  expect_same_pictures("standard", standard, true, false);
  expect_same_pictures("symmetric", symmetric, true, false);
  expect_same_pictures("pbrt", pbrt, true, false);
}

TEST(NormalizeCamera, LeftHandedWorldIsKnownByW) {
  Random random;
  Shot s = random_shot(random, false);
  s.camera.world_to_camera = diagonal(-1, 1, 1) * *s.camera.world_to_camera;  // mirror the world
  const Pair pair = standard(s, random);
  const Camera found =
      normalize_camera(pair.view, pair.ndc, s.display, static_cast<float>(s.camera.fy / s.camera.fx), 1);
  EXPECT_NEAR(found.fx, s.camera.fx, 1e-9);
  EXPECT_NEAR(found.cx, s.camera.cx, 1e-9);
  for (int i = 0; i < 16; ++i)
    EXPECT_NEAR((*found.world_to_camera)[i / 4][i % 4], (*s.camera.world_to_camera)[i / 4][i % 4], 1e-12);
}

TEST(NormalizeCamera, AnyLensShiftWithTheStandardNdc) {
  Random random;
  Shot s = random_shot(random, false);
  s.camera.cx = s.display.min_x + 3.0 * s.display.width();
  s.camera.cy = s.display.min_y - 1.0 * s.display.height();
  const Pair pair = standard(s, random);
  const Camera found = normalize_camera(pair.view, pair.ndc, s.display, 1, 1);
  EXPECT_NEAR(found.cx, s.camera.cx, 1e-6);
  EXPECT_NEAR(found.cy, s.camera.cy, 1e-6);
}

TEST(NormalizeCamera, LengthsBecomeMetres) {
  Random random;
  const Shot s = random_shot(random, false);
  const Pair pair = standard(s, random);
  const Camera found = normalize_camera(pair.view, pair.ndc, s.display, 1, 0.01);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR((*found.world_to_camera)[3][c], 0.01 * (*s.camera.world_to_camera)[3][c], 1e-12);
    EXPECT_NEAR((*found.world_to_camera)[0][c], (*s.camera.world_to_camera)[0][c], 1e-12);
  }
  EXPECT_NEAR(found.fx, s.camera.fx, 1e-9);
  const Shot flat = random_shot(random, true);
  const Pair flat_pair = standard(flat, random);
  EXPECT_NEAR(normalize_camera(flat_pair.view, flat_pair.ndc, flat.display, 1, 0.01).fx, 100 * flat.camera.fx, 1e-6);
}

TEST(NormalizeCamera, AspectThatDoesNotFitIsNoted) {
  Random random;
  const Shot s = random_shot(random, false);
  const Pair pair = standard(s, random);
  std::string note;
  normalize_camera(pair.view, pair.ndc, s.display, static_cast<float>(1.05 * s.camera.fy / s.camera.fx), 1, &note);
  EXPECT_NE(note.find("do not fit the pixel aspect"), std::string::npos) << note;
}

std::string refusal(const Mat4& view, const Mat4& ndc) {
  try {
    normalize_camera(view, ndc, {0, 0, 99, 99}, 1, 1);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::data);
    return error.message();
  }
  return "accepted";
}

TEST(NormalizeCamera, BadMatricesAreNamed) {
  Random random;
  const Shot s = random_shot(random, false);
  const Pair good = standard(s, random);
  Mat4 nan = good.view, flat = good.view, no_ndc = good.ndc;
  nan[1][2] = std::numeric_limits<double>::quiet_NaN();
  for (int c = 0; c < 4; ++c) flat[1][c] = flat[0][c];
  for (int r = 0; r < 4; ++r) no_ndc[r][0] = 0;
  EXPECT_EQ(refusal(nan, good.ndc), "worldToCamera holds a number that is not finite");
  EXPECT_EQ(refusal(good.view, nan), "worldToNDC holds a number that is not finite");
  EXPECT_EQ(refusal(flat, good.ndc), "worldToCamera is a singular matrix");
  EXPECT_EQ(refusal(good.view, no_ndc), "worldToNDC is a singular matrix");
  EXPECT_NE(refusal(good.view, standard(random_shot(random, false), random).ndc).find("do not belong"),
            std::string::npos);
  EXPECT_NE(refusal(good.ndc, good.ndc), "accepted");
}

TEST(CameraFileTest, BothForms) {
  const char* text = R"({"unit": "cm", "near": 10, "far": 100000, "frames": {
    "-1": {"focal_length_mm": 35, "aperture_width_mm": 36, "cameraToWorld": [1,0,0,0, 0,1,0,0, 0,0,1,0, 100,200,300,1]},
    "7": {"worldToCamera": [1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,500,1],
          "worldToNDC": [1,0,0,0, 0,-2,0,0, -0.5,-0.5,1,-1, 250,250,0,500]}}})";
  const CameraFile file = CameraFile::parse(text, "shot.json");
  EXPECT_EQ(file.unit(), "cm");
  const Window display{10, 20, 209, 119};  // 200 x 100
  const Camera lens = file.camera(-1, display, 2, 1);
  EXPECT_NEAR(lens.fx, 200 * 35.0 / 36, 1e-9);
  EXPECT_NEAR(lens.fy, 2 * lens.fx, 1e-9);
  EXPECT_NEAR(*lens.near_m, 0.1, 1e-12);
  EXPECT_NEAR(*lens.far_m, 1000, 1e-9);
  // The camera stands at (1, 2, 3) m and looks along -Z: a point 5 m before it, 1 m to its right.
  const Vec3 seen = transform_point(Vec3(2, 2, -2), *lens.world_to_camera);
  EXPECT_NEAR(seen.x, 1, 1e-12);
  EXPECT_NEAR(seen.y, 0, 1e-12);
  EXPECT_NEAR(seen.z, 5, 1e-12);
  const Camera matrices = file.camera(7, display, 1, 1);
  EXPECT_NEAR(matrices.fx, 200, 1e-9);
  EXPECT_NEAR(matrices.fy, 200, 1e-9);
  EXPECT_NEAR(matrices.cx, 110, 1e-9);
  EXPECT_NEAR((*matrices.world_to_camera)[3][2], 5, 1e-12);
}

std::string complaint(const std::string& text) {
  try {
    CameraFile::parse(text, "shot.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::config);
    return error.what();
  }
  return "accepted";
}

TEST(CameraFileTest, ComplaintsNameFileFrameAndKey) {
  const auto frame = [](const std::string& members) { return R"({"frames": {"12": {)" + members + "}}}"; };
  EXPECT_EQ(complaint(frame(R"("worldToCamera": [1, 2])")),
            "shot.json: frames.12.worldToCamera: has 2 numbers; a matrix has 16, row by row");
  EXPECT_NE(complaint(frame(R"("worldToCamra": [])"))
                .find("shot.json: frames.12: unknown key \"worldToCamra\" (did you mean \"worldToCamera\"?)"),
            std::string::npos);
  EXPECT_NE(complaint(frame(R"("focal_length_mm": 35)")).find("frames.12: needs worldToCamera"), std::string::npos);
  EXPECT_NE(complaint(frame(R"("focal_length_mm": -1)")).find("frames.12.focal_length_mm: -1 is out of range"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"frames": {"x": {}}})").find("not a frame number"), std::string::npos);
  EXPECT_NE(complaint(R"({"unit": "yard", "frames": {}})").find("shot.json: unit: \"yard\""), std::string::npos);
  EXPECT_NE(complaint(R"({"near": 5, "far": 1, "frames": {}})").find("far: must lie beyond near"), std::string::npos);
  EXPECT_NE(complaint("{}").find("\"frames\" is missing"), std::string::npos);
  EXPECT_NE(complaint("{").find("not valid JSON"), std::string::npos);
  EXPECT_NE(complaint(R"({"unit": "m", "unit": "cm", "frames": {}})").find("given twice"), std::string::npos);
  try {
    CameraFile::parse(R"({"frames": {}})", "shot.json").camera(5, {0, 0, 9, 9}, 1, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::no_input);
    EXPECT_NE(error.message().find("\"shot.json\" has no camera for frame 5"), std::string::npos);
  }
  EXPECT_THROW(CameraFile("/no/such/file.json"), Error);
}

}  // namespace
}  // namespace aftershade::io
