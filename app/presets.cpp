#include <algorithm>
#include <cstdio>

#include "app/commands.h"
#include "app/log.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/pipeline/pipeline.h"
#include "core/preset/preset.h"

namespace aftershade::app {

namespace {

void need_names(const PresetsArgs& args, size_t least, size_t most, std::string_view usage) {
  if (args.names.size() < least || args.names.size() > most)
    throw Error(ErrorCode::usage, cat("presets ", args.action, " takes ", usage), "see aftershade presets --help");
}

int list() {
  const std::vector<std::string> names = preset::shipped_presets();
  size_t longest = 0;
  for (const std::string& name : names) longest = std::max(longest, name.size());
  for (const std::string& name : names) {
    const std::string description = preset::load_preset(name).preset.description;
    const std::string first_sentence = description.substr(0, description.find(". ") + 1);
    std::printf("%-*s  %s\n", static_cast<int>(longest), name.c_str(), first_sentence.c_str());
  }
  return 0;
}

/// A file that has everything: what is wrong with a preset on it is wrong with the preset.
pipeline::Offer everything() {
  pipeline::Offer offer{{}, true, true};
  for (const RoleInfo& role : kRoles) offer.roles.insert(role.role);
  return offer;
}

/// Loads each preset and puts its stages together; reports all, the status is that of the first failure.
int validate(const std::vector<std::string>& names) {
  int status = 0;
  for (const std::string& name : names) try {
      with_context(name, [&] { pipeline::ViewPipeline(preset::load_preset(name).preset, "", everything(), {}); });
      std::printf("%s: valid\n", name.c_str());
    } catch (const Error& error) {
      log().error(error.what());
      if (status == 0) status = exit_status(error.code());
    }
  return status;
}

int diff(const std::string& a, const std::string& b) {
  for (const std::string& line : preset::difference(preset::load_preset(a).preset, preset::load_preset(b).preset))
    std::printf("%s\n", line.c_str());
  return 0;
}

}  // namespace

int presets(const PresetsArgs& args) {
  if (!args.sets.empty() && args.action != "show")
    throw Error(ErrorCode::usage, cat("presets ", args.action, " takes no --set"), "only presets show does");
  if (args.action == "list") return need_names(args, 0, 0, "no name"), list();
  if (args.action == "validate") return need_names(args, 1, 1000, "the files to check"), validate(args.names);
  if (args.action == "diff") return need_names(args, 2, 2, "two names or files"), diff(args.names[0], args.names[1]);
  if (args.action == "schema") {
    need_names(args, 0, 0, "no name");
    std::printf("%s\n", preset::schema().dump(2).c_str());
    return 0;
  }
  need_names(args, 1, 1, "one name or file");
  std::printf("%s\n", preset::to_json(preset::load_preset(args.names[0], args.sets).preset).dump(2).c_str());
  return 0;
}

}  // namespace aftershade::app
