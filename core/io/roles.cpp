#include "core/io/roles.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"

namespace aftershade::io {

namespace {

/// The Z of a vector: its layer has X and Y too (conventions 1.4). Such a channel is never depth.
bool is_vector_z(const ViewChannels& channels, const NamedChannel& channel) {
  if (to_lower(last_token(channel.name)) != "z") return false;
  const std::string prefix = channel.name.substr(0, channel.name.size() - 1);
  return channels.find(prefix + "X", channel.ref.part) && channels.find(prefix + "Y", channel.ref.part);
}

/// Is it what `profile` calls the second depth? Then the Z of a part "depth2" is not taken for the first one.
bool is_second_depth(const ViewChannels& channels, const NamedChannel& channel, const Profile& profile) {
  return std::ranges::any_of(profile.roles[static_cast<size_t>(Role::depth2)], [&](const Candidate& candidate) {
    return channels.matches(channel.ref, candidate.channels.front());
  });
}

/// A candidate bound to channels. One part is preferred, but some producers write one part a pass.
std::optional<std::vector<ChannelRef>> bind_role(const ViewChannels& channels, const std::vector<std::string>& patterns,
                                                 Role role, const Profile& profile) {
  const auto usable = [&](const NamedChannel& first) {
    if (role == Role::depth && is_second_depth(channels, first, profile)) return false;
    return !is_depth(role) || !is_vector_z(channels, first);
  };
  return channels.bind(patterns, patterns.size(), usable, /*one_part=*/false);
}

/// How overridden channels are encoded: as the candidate that they fit, else as the profile's first for this role.
Encoding encoding_of_override(const ViewChannels& channels, const std::vector<Candidate>& candidates,
                              const std::vector<ChannelRef>& refs) {
  for (const Candidate& candidate : candidates) {
    bool fits = candidate.channels.size() == refs.size();
    for (size_t i = 0; fits && i < refs.size(); ++i) fits = channels.matches(refs[i], candidate.channels[i]);
    if (fits) return candidate.encoding;
  }
  Encoding encoding = candidates.empty() ? Encoding{} : candidates.front().encoding;
  encoding.multiply = false;
  return encoding;
}

RoleBinding bind_override(const ViewChannels& channels, const RoleInfo& role, const Profile& profile,
                          const std::string& names) {
  RoleBinding out{.role = role.role, .channels = channels.overridden(role.name, names), .encoding = {}, .why = {}};
  out.why = cat("--channel ", role.name, "=", names);
  out.encoding = encoding_of_override(channels, profile.roles[static_cast<size_t>(role.role)], out.channels);
  const auto planes = static_cast<size_t>(role.planes);
  if (role.role == Role::ambient && out.channels.size() == 2 * planes) out.encoding.multiply = true;
  if (out.channels.size() != planes * (out.encoding.multiply ? 2 : 1))
    throw Error(ErrorCode::usage,
                cat("--channel ", role.name, "=", names, " names ", out.channels.size(), " channels; ", role.name,
                    " has ", planes),
                "separate channel names by commas");
  return out;
}

void check_override_keys(const std::map<std::string, std::string>& overrides) {
  std::vector<std::string> known{"color"};
  for (const RoleInfo& role : kRoles) known.emplace_back(role.name);
  for (const auto& [key, names] : overrides)
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string guess = did_you_mean(key, known);
      throw Error(ErrorCode::usage, cat("--channel ", key, "=", names, ": there is no role \"", key, "\""),
                  guess.empty() ? "roles are " + join(known, ", ") : guess);
    }
}

}  // namespace

std::vector<RoleBinding> resolve_roles(const FileInfo& info, const std::string& view, const Profile& profile,
                                       const std::map<std::string, std::string>& overrides) {
  check_override_keys(overrides);
  const ViewChannels channels(info, view);
  std::vector<RoleBinding> out;
  for (const RoleInfo& role : kRoles) {
    if (const auto names = overrides.find(std::string(role.name)); names != overrides.end()) {
      out.push_back(bind_override(channels, role, profile, names->second));
      continue;
    }
    for (const Candidate& candidate : profile.roles[static_cast<size_t>(role.role)])
      if (auto refs = bind_role(channels, candidate.channels, role.role, profile)) {
        out.push_back({role.role, std::move(*refs), candidate.encoding,
                       cat("profile ", profile.name, ": ", join(candidate.channels, ", "))});
        break;
      }
  }
  return out;
}

}  // namespace aftershade::io
