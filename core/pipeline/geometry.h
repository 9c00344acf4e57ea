#pragma once
#include <optional>

#include "core/filter/normals.h"
#include "core/filter/pyramid.h"
#include "core/image/frame.h"

namespace aftershade::pipeline {

/// Something that is made when it is first wanted, and what that cost.
template <class T>
struct MadeOnce {
  std::optional<T> value;
  double milliseconds = 0;
  size_t bytes = 0;  ///< its planes
};

/// What stages find out about a frame's depth as it was read: once for all presets that run on it, since their frames'
/// planes are the same (shared()).
struct Geometry final : SharedData {
  MadeOnce<filter::Normals> normals;
  MadeOnce<filter::DepthPyramid> pyramid;  ///< filter::kDepthLevels levels
};

}  // namespace aftershade::pipeline
