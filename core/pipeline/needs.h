#pragma once
#include "core/image/role.h"

namespace aftershade::pipeline {

/// What a stage declares about itself; Pipeline checks it against the first header before any pixel is read.
struct Needs {
  RoleSet required;            ///< roles without which the stage cannot run
  RoleSet optional;            ///< roles it uses if they are there
  RoleSet previous;            ///< roles it reads of frame f-1
  bool required_velocity = false;  ///< needs velocity_prev or velocity_next
  bool camera = false;         ///< uses a camera (a field of view is enough)
  bool layers = false;         ///< changes layers
  bool recursive = false;      ///< keeps history: a run starts `preroll` frames early
};

}  // namespace aftershade::pipeline
