#include "core/tune/frames_in_memory.h"

#include "core/pipeline/geometry.h"

namespace aftershade::tune {

std::optional<Frame> FramesInMemory::load(int number, const std::string& view, RoleSet roles, bool with_layers) {
  auto known = frames_.find({number, view});
  if (known == frames_.end()) {
    auto frame = source_.load(number, view, roles_, layers_);
    if (!frame) return std::nullopt;
    frame->file.reset();
    frame->geometry = std::make_shared<pipeline::Geometry>();
    known = frames_.emplace(std::pair(number, view), std::move(*frame)).first;
  }
  Frame out = shared(known->second);
  for (const RoleInfo& role : kRoles)
    if (!roles.contains(role.role)) out.planes(role.role).clear();
  if (!with_layers) out.layers.clear();
  if (!sharing_) out.geometry.reset();
  return out;
}

}  // namespace aftershade::tune
