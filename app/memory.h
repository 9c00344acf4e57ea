#pragma once
#include <cstdint>
#include <string>

#include "app/job.h"

/// How many frames a job may keep in memory.
namespace aftershade::app {

/// What a frame costs at most, all views together, in bytes, by the headers of the first frame.
struct FrameCost {
  int64_t read = 0;       ///< its planes as float, and the decoded bytes that are kept for writing
  int64_t computing = 0;  ///< that, what the stages make of it, and what they keep of other frames
  int64_t writing = 0;    ///< the planes to write, the decoded bytes, the new file
};
FrameCost frame_cost(const RenderArgs& args, const Job& job);

/// The peak with 1, 2 or 3 frames at once (pipeline::RunOptions::frames_in_flight).
int64_t peak_of(const FrameCost& cost, size_t frames_in_flight);

/// The most frames at once, 1 to 3, that `limit` bytes allow; 1 when even that is too much.
size_t frames_in_flight(const FrameCost& cost, int64_t limit);

/// The limit of --memory, or half of what there is (INT64_MAX when nobody knows). Error(usage) for no size.
int64_t memory_limit(const std::string& option);

}  // namespace aftershade::app
