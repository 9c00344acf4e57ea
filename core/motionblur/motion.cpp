#include "core/motionblur/motion.h"

namespace aftershade::motionblur {

Shutter shutter_of(const PathParams& params, float shutter_frames) {
  switch (params.shutter_phase) {
    case ShutterPhase::centred:
      return {-0.5F * shutter_frames, 0.5F * shutter_frames};
    case ShutterPhase::start:
      return {0, shutter_frames};
    case ShutterPhase::end:
      return {-shutter_frames, 0};
    case ShutterPhase::custom:
      break;
  }
  return {params.shutter_opens_frames, params.shutter_opens_frames + shutter_frames};
}

}  // namespace aftershade::motionblur
