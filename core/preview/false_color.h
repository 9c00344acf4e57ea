#pragma once
#include <span>
#include <vector>

#include "core/preview/sheet.h"

/// Pictures of things that are no colours, as display values 0..1. NaN is black everywhere.
namespace aftershade::preview {

/// Least and largest of the finite values; 0 and 0 if there are none.
struct Range {
  float least = 0, largest = 0;
};
Range range_of(ConstPlaneView plane);

/// `black` and below become 0, `white` and above 1, evenly between; all 0 when they are equal.
Plane scaled(ConstPlaneView plane, float black, float white);

/// Three planes: the colour whose index in `palette` the rounded value is; black for what has none.
std::vector<Plane> coded(ConstPlaneView codes, std::span<const Rgb> palette);

/// Length of the longest vector, those left out that are not finite.
float longest_of(ConstPlaneView x, ConstPlaneView y);

/// The colour of a vector's direction, y down: right is red, down yellow-green, left cyan, up violet (hue grows
/// clockwise as one sees it). Brightness is the length as a share of `longest`, up to 1.
Rgb wheel_color(float x, float y, float longest);

/// Three planes: each vector's wheel_color(); black where `longest` is 0.
std::vector<Plane> wheel(ConstPlaneView x, ConstPlaneView y, float longest);

/// A disc that shows the colour of every direction, with the longest vectors at its rim; size_px x size_px.
std::vector<Plane> wheel_key(int size_px);

}  // namespace aftershade::preview
