#pragma once
#include <string>

#include "tests/support/truth.h"

/// Scenes as files, in the conventions of the "generic" producer profile.
namespace aftershade::tests {

/// Adds gaussian-like noise of this rms, in display values (gamma 1/2.2), to R, G and B, as path tracers leave it. The
/// same for the same pixel and frame number.
void add_render_noise(Frame& frame, double rms);

/// R G B A half (scene-linear); Z float, planar metres, background 1e10; depth2.Z likewise, if the frame has it; N.X .Y
/// .Z half, world space; forward.u .v and backward.u .v float: displacement in pixels to the next and to the previous
/// frame, y up; diffuse_indirect.R .G .B half: the ambient part of the colour. Attributes worldToCamera and worldToNDC
/// as OpenEXR defines them.
void write_scene_file(const Frame& frame, const std::string& path);

/// One channel "AO", half, 1 = open.
void write_ao_file(const Frame& frame, ConstPlaneView ao, const std::string& path);
/// R G B A half.
void write_color_file(const Frame& frame, const std::vector<Plane>& rgba, const std::string& path);

}  // namespace aftershade::tests
