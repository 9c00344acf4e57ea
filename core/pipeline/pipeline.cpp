#include "core/pipeline/pipeline.h"

#include <algorithm>
#include <chrono>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::pipeline {

namespace {

[[noreturn]] void fail_role(const std::string& id, std::string_view method, const std::string& what) {
  throw Error(ErrorCode::no_input, cat("stage ", id, " (", method, ") needs ", what, ", which the file does not show"),
              cat("name the channel with --channel or --role, or leave the stage out with --skip ", id));
}

void check_needs(const std::string& id, std::string_view method, const Needs& needs, const Offer& offer) {
  if (needs.position && !offer.position)
    throw Error(ErrorCode::no_input, cat("stage ", id, " (", method, ") needs to know where the camera stands"),
                "the header has no camera matrices: give --camera FILE.json, or set " + id + ".reprojection=auto");
  if (needs.lens && !offer.lens)
    throw Error(ErrorCode::no_input, cat("stage ", id, " (", method, ") needs to know the camera's field of view"),
                "the header has no camera matrices: give --fov DEGREES or --camera FILE.json, or leave the stage out "
                "with --skip " +
                    id);
  std::vector<std::string> any;
  bool found = needs.any_of.empty();
  for (const RoleInfo& role : kRoles) {
    if (needs.required.contains(role.role) && !offer.roles.contains(role.role))
      fail_role(id, method, std::string(role.name));
    if (!needs.any_of.contains(role.role)) continue;
    any.emplace_back(role.name);
    found = found || offer.roles.contains(role.role);
  }
  if (!found) fail_role(id, method, join(any, " or "));
}

/// Filters may leave 0..1 by a rounding error.
Plane clamped(Plane ao) {
  for (int y = 0; y < ao.height(); ++y)
    for (int x = 0; x < ao.width(); ++x) ao(x, y) = std::clamp(ao(x, y), 0.0F, 1.0F);
  return ao;
}

/// What the stages so far leave for the next.
struct Made {
  bool ao = false, ao_at_pixels = false, grid = false;
  void add(const Needs& needs) {
    ao = ao || needs.makes_ao;
    ao_at_pixels = needs.makes_ao_at_pixels || (ao_at_pixels && !needs.makes_ao);
    grid = needs.makes_ao || (grid && !needs.window);
  }
};

void check_order(const std::string& id, const Needs& needs, const Made& made) {
  if (needs.ao && !made.ao)
    throw Error(ErrorCode::config, cat("stage ", id, " works on AO, but no stage before it makes any"),
                "put an AO stage before it, or leave it out with --skip " + id);
  if (needs.ao_at_pixels && !made.ao_at_pixels)
    throw Error(ErrorCode::config, cat("stage ", id, " needs AO at full resolution"),
                "put a bilateral-upsample stage before it");
  if (needs.grid && !made.grid)
    throw Error(ErrorCode::config, cat("stage ", id, " works on AO, but stands behind a stage that blurs the image"),
                "put it before the motion blur");
}

}  // namespace

ViewPipeline::ViewPipeline(const preset::Preset& preset, std::string view, const Offer& offer, const Outputs& outputs)
    : view_(std::move(view)), outputs_(outputs) {
  Made made;
  for (const preset::StageDescription& description : preset.stages) {
    Entry entry{description.id, make_stage(description.params), {}};
    entry.needs = entry.stage->needs(offer);
    if (entry.needs.layers && !outputs.layers) continue;
    check_needs(entry.id, preset::method_of(description.params), entry.needs, offer);
    check_order(entry.id, entry.needs, made);
    made.add(entry.needs);
    if (entry.needs.recursive) last_recursive_ = static_cast<int>(stages_.size());
    stages_.push_back(std::move(entry));
  }
  if (outputs.ao_channel && !made.ao_at_pixels)
    throw Error(ErrorCode::config, "the AO channel is wanted, but no stage makes AO at full resolution",
                "choose a preset with AO, or leave out --ao and --ao-only");
}

bool ViewPipeline::changes_layers() const {
  for (const Entry& entry : stages_)
    if (entry.needs.layers) return true;
  return false;
}

RoleSet ViewPipeline::roles(bool written) const {
  RoleSet roles;
  const int count = written ? static_cast<int>(stages_.size()) : last_recursive_ + 1;
  for (int i = 0; i < count; ++i) {
    const Needs& needs = stages_[static_cast<size_t>(i)].needs;
    roles.insert(needs.required);
    roles.insert(needs.any_of);
    roles.insert(needs.optional);
  }
  return roles;
}

RoleSet ViewPipeline::previous_roles() const {
  RoleSet roles;
  for (const Entry& entry : stages_) roles.insert(entry.needs.previous);
  return roles;
}

ViewPipeline::Result ViewPipeline::run(Frame& frame, const Frame* previous, bool written, bool restart) {
  if (restart || display_before_ != frame.display)
    for (Entry& entry : stages_) entry.stage->restart();
  display_before_ = frame.display;
  Result result;
  Work work(frame, previous, outputs_.work);
  for (size_t i = 0; i < stages_.size(); ++i) {
    if (!written && static_cast<int>(i) > last_recursive_) break;
    const auto start = std::chrono::steady_clock::now();
    stages_[i].stage->run(work);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    result.times.push_back({stages_[i].id, time.count()});
  }
  if (outputs_.ao_channel && written) frame.added[*outputs_.ao_channel] = clamped(std::move(work.ao));
  result.notes = std::move(work.notes);
  result.warnings = std::move(work.warnings);
  return result;
}

}  // namespace aftershade::pipeline
