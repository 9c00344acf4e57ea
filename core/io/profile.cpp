#include "core/io/profile.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/json.h"

namespace aftershade::profiles {
std::span<const EmbeddedFile> embedded_files();
}

namespace aftershade::io {

namespace {

/// "*.Normal.{X,Y,Z}" as three patterns; a text without braces as itself.
std::vector<std::string> expand_braces(const std::string& text) {
  const size_t open = text.find('{'), close = text.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {text};
  std::vector<std::string> out;
  for (const std::string& choice : split(std::string_view(text).substr(open + 1, close - open - 1), ','))
    out.push_back(text.substr(0, open) + choice + text.substr(close + 1));
  return out;
}

/// A channel list: one text or a list of texts, each with braces.
std::vector<std::string> channel_patterns(const JsonReader& value) {
  std::vector<std::string> out;
  const auto add = [&](const JsonReader& text) {
    for (std::string& pattern : expand_braces(text.text())) out.push_back(std::move(pattern));
  };
  if (value.is_text())
    add(value);
  else
    for (const JsonReader& element : value.elements()) add(element);
  return out;
}

std::array<double, 3> scales(const JsonReader& value, int planes) {
  std::array<double, 3> out{1, 1, 1};
  const auto elements = value.elements();
  if (elements.size() != static_cast<size_t>(planes)) value.fail(cat("needs ", planes, " numbers, one a channel"));
  for (size_t i = 0; i < elements.size(); ++i) out[i] = elements[i].number();
  return out;
}

void read_depth(const JsonReader& object, Encoding& encoding) {
  std::vector<std::string> kinds;
  for (const auto& [name, kind] : kDepthKinds) kinds.emplace_back(name);
  object.optional("kind", [&](const JsonReader& v) {
    encoding.depth_kind = kDepthKinds[static_cast<size_t>(v.choice(kinds))].second;
  });
  object.optional("background_above", [&](const JsonReader& v) { encoding.background_above = v.number(); });
  object.optional("zero_is_background", [&](const JsonReader& v) { encoding.zero_is_background = v.boolean(); });
}

void read_velocity(const JsonReader& object, Encoding& encoding) {
  object.optional("unit", [&](const JsonReader& v) {
    encoding.velocity_unit = static_cast<VelocityUnit>(v.choice({"pixels", "screen"}));
  });
  object.optional("sentinel_above", [&](const JsonReader& v) { encoding.sentinel_above = v.number(); });
}

/// The keys that a candidate of `role` may have.
std::vector<std::string> candidate_keys(Role role) {
  std::vector<std::string> keys{"channels", "scale", "neutral"};
  switch (role) {
    case Role::depth:
      keys.insert(keys.end(), {"kind", "background_above", "zero_is_background"});
      break;
    case Role::depth2:
      return {"channels"};
    case Role::normal:
      keys.push_back("space");
      break;
    case Role::velocity_prev:
    case Role::velocity_next:
      keys.insert(keys.end(), {"unit", "sentinel_above"});
      break;
    case Role::ambient:
      keys.push_back("multiply");
      break;
    case Role::ao:
      break;
  }
  return keys;
}

Candidate read_candidate(const JsonReader& object, const RoleInfo& role) {
  Candidate out;
  object.allow(candidate_keys(role.role));
  object.optional("scale", [&](const JsonReader& v) { out.encoding.scale = scales(v, role.planes); });
  object.optional("neutral", [&](const JsonReader& v) { out.encoding.neutral = v.number(); });
  object.optional("multiply", [&](const JsonReader& v) { out.encoding.multiply = v.boolean(); });
  object.optional("space", [&](const JsonReader& v) {
    out.encoding.normal_space = static_cast<NormalSpace>(v.choice({"world", "camera"}));
  });
  if (role.role == Role::depth) read_depth(object, out.encoding);
  if (role.role == Role::velocity_prev || role.role == Role::velocity_next) read_velocity(object, out.encoding);
  const JsonReader channels = object.required("channels");
  out.channels = channel_patterns(channels);
  const size_t count = static_cast<size_t>(role.planes) * (out.encoding.multiply ? 2 : 1);
  if (out.channels.size() != count)
    channels.fail(cat("names ", out.channels.size(), " channels, but ", role.name, " has ", count));
  return out;
}

Profile::Sign read_sign(const JsonReader& object) {
  Profile::Sign sign;
  object.allow({"attribute", "contains", "channel"});
  object.optional("attribute", [&](const JsonReader& v) { sign.attribute = v.text(); });
  object.optional("contains", [&](const JsonReader& v) { sign.contains = v.text(); });
  object.optional("channel", [&](const JsonReader& v) { sign.channel = v.text(); });
  if (sign.attribute.empty() == sign.channel.empty()) object.fail("needs either \"attribute\" or \"channel\"");
  if (!sign.contains.empty() && sign.attribute.empty()) object.fail("\"contains\" belongs to \"attribute\"");
  return sign;
}

void read_colors(const JsonReader& value, Profile& profile) {
  for (const JsonReader& candidate : value.elements()) {
    profile.color.push_back(channel_patterns(candidate));
    const size_t count = profile.color.back().size();
    if (count != 3 && count != 4) candidate.fail(cat("names ", count, " channels; colour has R G B and perhaps A"));
  }
}

Profile read_profile(const JsonReader& root) {
  Profile profile;
  std::vector<std::string> keys{"description", "detect", "color", "camera", "unit"};
  for (const RoleInfo& role : kRoles) keys.emplace_back(role.name);
  root.allow(keys);
  root.optional("description", [&](const JsonReader& v) { profile.description = v.text(); });
  root.optional("unit", [&](const JsonReader& v) { profile.unit = read_unit(v); });
  root.optional("color", [&](const JsonReader& v) { read_colors(v, profile); });
  root.optional("detect", [&](const JsonReader& v) {
    for (const JsonReader& sign : v.elements()) profile.detect.push_back(read_sign(sign));
  });
  root.optional("camera", [&](const JsonReader& v) {
    v.allow({"world_to_camera", "world_to_ndc"});
    v.optional("world_to_camera", [&](const JsonReader& name) { profile.camera.world_to_camera = name.text(); });
    v.optional("world_to_ndc", [&](const JsonReader& name) { profile.camera.world_to_ndc = name.text(); });
  });
  for (const RoleInfo& role : kRoles)
    root.optional(std::string(role.name), [&](const JsonReader& v) {
      for (const JsonReader& element : v.elements())
        profile.roles[static_cast<size_t>(role.role)].push_back(read_candidate(element, role));
    });
  return profile;
}

std::optional<std::string> sign_in(const Profile::Sign& sign, const ExrReader& file) {
  for (size_t part = 0; part < file.info().parts.size(); ++part) {
    const int index = static_cast<int>(part);
    if (!sign.channel.empty())
      for (const ChannelInfo& channel : file.info().parts[part].channels)
        if (glob_match(sign.channel, channel.name)) return "channel " + channel.name;
    if (sign.attribute.empty()) continue;
    for (const std::string& name : file.attribute_names(index)) {
      if (!glob_match(sign.attribute, name)) continue;
      if (sign.contains.empty()) return "attribute " + name;
      const std::string text = file.text(index, name).value_or("");
      if (to_lower(text).find(to_lower(sign.contains)) != std::string::npos)
        return cat("attribute ", name, " = \"", text, "\"");
    }
  }
  return std::nullopt;
}

std::string file_stem(std::string_view file_name) {
  std::string_view stem = file_name.substr(file_name.rfind('/') + 1);
  if (stem.ends_with(".json")) stem.remove_suffix(5);
  return std::string(stem);
}

}  // namespace

std::optional<DepthKind> depth_kind_named(std::string_view name) {
  const auto found = std::ranges::find(kDepthKinds, name, [](const auto& named) { return named.first; });
  return found == kDepthKinds.end() ? std::nullopt : std::optional(found->second);
}

std::span<const EmbeddedFile> builtin_profiles() { return profiles::embedded_files(); }

Profile parse_profile(std::string_view json, std::string_view file_name) {
  const JsonDocument document(json, file_name);
  Profile profile = read_profile(document.root());
  profile.name = file_stem(file_name);
  return profile;
}

Profile load_profile(const std::string& name_or_file) {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : builtin_profiles()) {
    if (file.name == name_or_file) return parse_profile(file.text, file.name);
    names.emplace_back(file.name);
  }
  if (!name_or_file.ends_with(".json")) {
    const std::string guess = did_you_mean(name_or_file, names);
    throw Error(ErrorCode::config, cat("there is no producer profile \"", name_or_file, "\""),
                guess.empty() ? cat("shipped are ", join(names, ", "), "; a file needs the ending .json") : guess);
  }
  return parse_profile(read_text_file(name_or_file), name_or_file);
}

Detected detect_profile(const ExrReader& file) {
  for (const EmbeddedFile& builtin : builtin_profiles()) {
    Profile profile = parse_profile(builtin.text, builtin.name);
    for (const Profile::Sign& sign : profile.detect)
      if (auto why = sign_in(sign, file)) return {std::move(profile), std::move(*why)};
  }
  return {load_profile("generic"), "no known producer"};
}

}  // namespace aftershade::io
