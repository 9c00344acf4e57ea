#pragma once
#include <string>
#include <vector>

#include "core/image/role.h"
#include "core/pipeline/aov.h"

namespace aftershade::pipeline {

/// What the first frame of a view offers; needs are checked against it before any pixel is read.
struct Offer {
  RoleSet roles;
  bool lens = false;      ///< a camera with a known field of view
  bool position = false;  ///< and a known world-to-camera matrix
};

/// What a stage declares about itself, given what there is.
struct Needs {
  RoleSet required;                   ///< roles without which the stage cannot run
  RoleSet any_of;                     ///< at least one of these (empty: no such demand)
  std::string or_else;                ///< what would do instead of any_of and is not there either, for the error
  RoleSet optional;                   ///< roles it uses if they are there
  RoleSet previous;                   ///< roles it reads of frame f-1
  bool lens = false;                  ///< needs to know the field of view
  bool position = false;              ///< needs to know where the camera stands
  std::string without_position;       ///< "key=value" of this stage that takes this need away, for the error
  bool ao = false;                    ///< works on AO made by an earlier stage ...
  bool ao_at_pixels = false;          ///< ... which must be at full resolution by then
  bool grid = false;                  ///< ... and looks at the pixels that it was evaluated at
  std::vector<std::string> channels;  ///< works on these channels of the file: Frame::named
  AovSet aovs;                        ///< intermediate results that it has
  bool makes_ao = false;
  bool makes_ao_at_pixels = false;
  bool layers = false;     ///< changes layers
  bool window = false;     ///< may change the working window: AO made before it loses its grid
  bool recursive = false;  ///< keeps history: a run starts `preroll` frames early
  /// Frames around its own that it sees as the stages before it leave them; only frames that follow each other without
  /// a gap are given. The result is a pure function of these frames.
  int frames_before = 0, frames_after = 0;
  bool has_window() const { return frames_before > 0 || frames_after > 0; }
};

}  // namespace aftershade::pipeline
