#pragma once
#include <string>
#include <string_view>

#include "core/preset/preset.h"

/// How one preset file, or one --set, changes the stages it builds on. Internal to core/preset.
namespace aftershade::preset {

/// Keys of a stage in a file that are not parameters of its method.
inline constexpr std::string_view kStageKeys[] = {"id", "method", "before", "after", "remove"};

/// Applies a whole preset file to `base` (what it extends; empty if nothing): description and stages, merged by id.
/// `label` names the file: it leads every message and is the origin of the values that the file gives. Throws
/// Error(config).
void merge_file(Resolved& base, const params::Json& json, const std::string& label);

/// Applies "ao.radius_m=1.5"; the keys of kStageKeys work too ("upsample.remove=true"). Throws Error(config).
void merge_set(Resolved& base, std::string_view assignment);

}  // namespace aftershade::preset
