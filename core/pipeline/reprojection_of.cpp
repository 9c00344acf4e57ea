#include "core/pipeline/reprojection_of.h"

namespace aftershade::pipeline {

void add_reprojection_needs(Needs& needs, const Offer& offer, temporal::ReprojectionSource source) {
  needs.position = source == temporal::ReprojectionSource::camera;
  needs.without_position = "reprojection=auto";
  if (source == temporal::ReprojectionSource::camera) return;
  needs.optional.insert(Role::velocity_prev);
  if (!offer.roles.contains(Role::velocity_prev) && offer.roles.contains(Role::velocity_next))
    needs.previous.insert({Role::velocity_next, Role::depth});
  if (!offer.position) needs.any_of.insert({Role::velocity_prev, Role::velocity_next});
}

ReprojectionSources reprojection_sources(Work& work, const std::optional<Camera>& before) {
  ReprojectionSources sources;
  temporal::ReprojectionInput& input = sources.input;
  input.depth = work.frame.depth();
  input.window = work.frame.window;
  if (before) input.camera = CameraReprojection::create(*work.frame.camera, *before);
  if (!work.frame.camera->world_to_camera)
    work.note("no camera matrices: reprojection follows the vectors alone, and the depth test uses the stored depth");
  if (work.frame.has(Role::velocity_prev)) {
    input.mv_prev_x = work.frame.planes(Role::velocity_prev)[0];
    input.mv_prev_y = work.frame.planes(Role::velocity_prev)[1];
  } else if (work.previous && work.previous->has(Role::velocity_next)) {
    const auto& next = work.previous->planes(Role::velocity_next);
    sources.scattered =
        temporal::scatter_velocity(next[0], next[1], work.previous->depth(), work.previous->window, work.frame.window);
    input.holes_are_invalid = true;
    input.mv_prev_x = sources.scattered.x;
    input.mv_prev_y = sources.scattered.y;
    work.note("no backward vectors: those of the frame before are carried forward");
  }
  return sources;
}

temporal::Reprojected reprojection_of(Work& work, const std::optional<Camera>& before,
                                      temporal::ReprojectionSource source, float agreement_px) {
  return temporal::reproject(reprojection_sources(work, before).input, source, agreement_px);
}

}  // namespace aftershade::pipeline
