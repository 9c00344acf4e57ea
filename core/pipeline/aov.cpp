#include "core/pipeline/aov.h"

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

AovSet aovs_of(const preset::Preset& preset, bool layers) {
  AovSet set;
  for (const preset::StageDescription& stage : preset.stages) {
    const Needs needs = make_stage(stage.params)->needs({});
    if (layers || (!needs.layers && needs.channels.empty())) set.insert(needs.aovs);
  }
  return set;
}

std::vector<std::string> names_of(AovSet aovs) {
  std::vector<std::string> names;
  for (const AovInfo& entry : kAovs)
    if (aovs.contains(entry.aov)) names.emplace_back(entry.name);
  return names;
}

AovSet aovs_from_names(const std::vector<std::string>& lists, AovSet offered) {
  AovSet set;
  for (const std::string& list : lists)
    for (const std::string& name : split(list, ',')) {
      const auto aov = aov_from_name(name);
      if (name == "all") {
        set.insert(offered);
      } else if (aov && offered.contains(*aov)) {
        set.insert(*aov);
      } else {
        const std::vector<std::string> names = names_of(offered);
        std::string hint = aov ? "" : did_you_mean(name, names);
        hint += cat(hint.empty() ? "" : " ", "the preset has ", names.empty() ? "none" : join(names, ", "));
        throw Error(ErrorCode::usage,
                    aov ? cat("no stage of the preset has the AOV ", name) : cat("there is no AOV \"", name, "\""),
                    hint);
      }
    }
  return set;
}

}  // namespace aftershade::pipeline
