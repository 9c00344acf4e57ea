#include "core/pipeline/pipeline.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/pipeline/item.h"

namespace aftershade::pipeline {

namespace {

[[noreturn]] void fail_role(const std::string& id, std::string_view method, const std::string& what) {
  throw Error(ErrorCode::no_input, cat("stage ", id, " (", method, ") needs ", what, ", which the file does not show"),
              cat("name the channel with --channel or --role, or leave the stage out with --skip ", id));
}

void check_needs(const std::string& id, std::string_view method, const Needs& needs, const Offer& offer) {
  if (needs.position && !offer.position)
    throw Error(ErrorCode::no_input, cat("stage ", id, " (", method, ") needs to know where the camera stands"),
                "the header has no camera matrices: give --camera FILE.json, or " +
                    (needs.without_position.empty() ? "leave the stage out with --skip " + id
                                                    : cat("set ", id, ".", needs.without_position)));
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
  if (!found) fail_role(id, method, join(any, " or ") + needs.or_else);
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
    Entry entry{description.id, make_stage(description.params), {}, {}};
    entry.needs = entry.stage->needs(offer);
    if (!outputs.layers && (entry.needs.layers || !entry.needs.channels.empty())) continue;
    check_needs(entry.id, preset::method_of(description.params), entry.needs, offer);
    check_order(entry.id, entry.needs, made);
    made.add(entry.needs);
    stages_.push_back(std::move(entry));
  }
  makes_ao_ = made.ao_at_pixels;
  if (outputs.ao_channel && !made.ao_at_pixels)
    throw Error(ErrorCode::config, "the AO channel is wanted, but no stage makes AO at full resolution",
                "choose a preset with AO, or leave out --ao and --ao-only");
}

std::vector<Dependency> ViewPipeline::dependencies() const {
  std::vector<Dependency> dependencies;
  for (size_t i = 0; i < stages_.size(); ++i) {
    const Needs& needs = stages_[i].needs;
    if (needs.recursive || needs.has_window())
      dependencies.push_back({i, needs.frames_before, needs.frames_after, needs.recursive});
  }
  return dependencies;
}

/// Does a frame that goes `through` meet this stage, to be run or at least to be shown?
bool ViewPipeline::sees(size_t stage, size_t through) const {
  if (stage >= stages_.size()) return false;
  return stage < through || (stage == through && stages_[stage].needs.has_window());
}

RoleSet ViewPipeline::roles(size_t through) const {
  RoleSet roles;
  for (size_t i = 0; i < stages_.size(); ++i) {
    if (!sees(i, through)) continue;
    roles.insert(stages_[i].needs.required);
    roles.insert(stages_[i].needs.any_of);
    roles.insert(stages_[i].needs.optional);
  }
  return roles;
}

bool ViewPipeline::layers(size_t through) const {
  for (size_t i = 0; i < stages_.size(); ++i)
    if (sees(i, through) && stages_[i].needs.layers) return true;
  return false;
}

RoleSet ViewPipeline::previous_roles() const {
  RoleSet roles;
  for (const Entry& entry : stages_) roles.insert(entry.needs.previous);
  return roles;
}

}  // namespace aftershade::pipeline
