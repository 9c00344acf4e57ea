#pragma once
#include <cstddef>
#include <memory>
#include <utility>

namespace aftershade {

/// Refers to a float image somebody else owns: row y starts at data + y * stride. `T` is float or const float.
template <class T>
struct BasicPlaneView {
  T* data = nullptr;
  int width = 0, height = 0;
  std::ptrdiff_t stride = 0;  ///< floats from one row to the next

  T* row(int y) const { return data + y * stride; }
  T& operator()(int x, int y) const { return row(y)[x]; }
  bool empty() const { return width <= 0 || height <= 0; }
  operator BasicPlaneView<const T>() const { return {data, width, height, stride}; }
};
using PlaneView = BasicPlaneView<float>;
using ConstPlaneView = BasicPlaneView<const float>;

/// Owns a float image. Rows start at 64-byte boundaries and have at least kPadding readable and writable floats behind
/// the last pixel, so that kernels need no tail loop; the padding is never part of a result. Movable; copy with
/// copy_of(), or let several planes be the same pixels with shared(): whoever then wants to change some calls
/// make_own() first. Storage is recycled (core/image/plane_memory.h).
class Plane {
 public:
  static constexpr int kPadding = 16;
  Plane() = default;
  Plane(int width, int height, float fill = 0.0F);
  /// Pixels with any value, for somebody who writes every one; the padding is 0.
  static Plane for_overwrite(int width, int height);
  Plane(Plane&& other) noexcept : storage_(std::move(other.storage_)), view_(std::exchange(other.view_, {})) {}
  Plane& operator=(Plane&& other) noexcept {
    storage_ = std::move(other.storage_);
    view_ = std::exchange(other.view_, {});
    return *this;
  }

  /// The same pixels again, which neither plane may change from now on.
  Plane shared() const {
    Plane out;
    out.storage_ = storage_;
    out.view_ = view_;
    return out;
  }
  /// Nobody else sees these pixels after this: copies them if they are shared.
  void make_own();

  int width() const { return view_.width; }
  int height() const { return view_.height; }
  bool empty() const { return view_.empty(); }
  float* row(int y) { return view_.row(y); }
  const float* row(int y) const { return view_.row(y); }
  float& operator()(int x, int y) { return view_(x, y); }
  float operator()(int x, int y) const { return view_(x, y); }
  PlaneView view() { return view_; }
  ConstPlaneView view() const { return view_; }
  operator PlaneView() { return view_; }
  operator ConstPlaneView() const { return view_; }

 private:
  std::shared_ptr<float> storage_;
  PlaneView view_;
};

/// A new plane with the same pixels.
Plane copy_of(ConstPlaneView source);
/// Copies pixels where the two overlap when source's (0,0) lies at (x, y) of target.
void copy_at(ConstPlaneView source, PlaneView target, int x, int y);

}  // namespace aftershade
