#include <algorithm>
#include <array>
#include <cctype>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/roles.h"

namespace aftershade::io {

namespace {

/// 0 to 3 for red, green, blue, alpha; -1 for any other suffix.
int color_index(const std::string& suffix) {
  static const std::array<std::array<std::string_view, 2>, 4> words{
      {{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}}};
  const std::string word = to_lower(suffix);
  for (size_t i = 0; i < words.size(); ++i)
    if (word == words[i][0] || word == words[i][1]) return static_cast<int>(i);
  return -1;
}

int alpha_of(const std::vector<ChannelRef>& channels) {
  for (size_t i = 0; i < channels.size(); ++i)
    if (color_index(last_token(channels[i].channel)) == 3) return static_cast<int>(i);
  return -1;
}

std::optional<ColorBinding> find_beauty(const ViewChannels& channels, const Profile& profile,
                                        const std::map<std::string, std::string>& overrides) {
  std::optional<std::vector<ChannelRef>> refs;
  if (const auto names = overrides.find("color"); names != overrides.end()) {
    refs = channels.overridden("color", names->second);
    if (refs->size() != 3 && refs->size() != 4)
      throw Error(ErrorCode::usage,
                  cat("--channel color=", names->second, " names ", refs->size(), " channels; give R,G,B or R,G,B,A"));
    for (const ChannelRef& ref : *refs)
      if (ref.part != refs->front().part)
        throw Error(ErrorCode::usage,
                    cat("--channel color=", names->second, ": the channels lie in different parts of the file"));
  }
  for (const auto& patterns : profile.color) {
    if (refs) break;
    refs = channels.bind(
        patterns, 3, [](const NamedChannel&) { return true; }, /*one_part=*/true);
  }
  if (!refs) return std::nullopt;
  const int alpha = refs->size() == 4 ? 3 : -1;
  return ColorBinding{.layer = "", .channels = std::move(*refs), .alpha = alpha, .is_beauty = true};
}

struct Group {
  std::string layer;
  int part;
  std::vector<NamedChannel> channels;
};

std::vector<Group> groups_of(const ViewChannels& channels) {
  std::vector<Group> groups;
  for (const NamedChannel& channel : channels.all()) {
    const std::string layer = layer_of(channel.name);
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& g) { return g.layer == layer && g.part == channel.ref.part; });
    if (group == groups.end()) group = groups.insert(groups.end(), {layer, channel.ref.part, {}});
    group->channels.push_back(channel);
  }
  return groups;
}

/// The group as R G B [A], nullopt when it has none of that.
std::optional<ColorBinding> as_color(const Group& group) {
  std::array<const NamedChannel*, 4> found{};
  for (const NamedChannel& channel : group.channels)
    if (const int index = color_index(last_token(channel.name)); index >= 0 && !found[static_cast<size_t>(index)])
      found[static_cast<size_t>(index)] = &channel;
  if (!found[0] || !found[1] || !found[2]) return std::nullopt;
  ColorBinding out{
      .layer = group.layer, .channels = {found[0]->ref, found[1]->ref, found[2]->ref}, .alpha = -1, .is_beauty = false};
  if (found[3]) {
    out.alpha = 3;
    out.channels.push_back(found[3]->ref);
  }
  return out;
}

bool ends_with_digits_after(const std::string& text, std::string_view name) {
  return text.size() >= name.size() && text.starts_with(name) &&
         std::all_of(text.begin() + static_cast<std::ptrdiff_t>(name.size()), text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Coverage and identifiers: no colour, never filtered (conventions 1.3). By the header's names, and by the customary
/// spelling in files that lost their header.
bool is_cryptomatte(const std::string& layer, const std::vector<std::string>& cryptomattes) {
  const std::string last = to_lower(last_token(layer));
  if (last.find("crypto") != std::string::npos && std::isdigit(static_cast<unsigned char>(last.back()))) return true;
  return std::any_of(cryptomattes.begin(), cryptomattes.end(),
                     [&](const std::string& name) { return ends_with_digits_after(layer, name); });
}

[[noreturn]] void refuse_cryptomatte(const std::string& name) {
  throw Error(ErrorCode::usage, cat("\"", name, "\" is a Cryptomatte: its identifiers cannot be changed"));
}

/// "shadow.R, shadow.G, shadow.B" for the layer "shadow"; "" if there is no such layer.
std::string channels_of_layer(const ViewChannels& channels, const std::string& layer) {
  std::vector<std::string> names;
  for (const NamedChannel& channel : channels.all())
    if (!layer.empty() && layer_of(channel.name) == layer) names.push_back(channel.name);
  return join(names, ", ");
}

}  // namespace

std::vector<std::string> cryptomatte_names(const ExrReader& file) {
  std::vector<std::string> names;
  for (int part = 0; part < static_cast<int>(file.info().parts.size()); ++part)
    for (const std::string& attribute : file.attribute_names(part))
      if (glob_match("cryptomatte/*/name", attribute))
        if (auto name = file.text(part, attribute)) names.push_back(std::move(*name));
  return names;
}

std::vector<ColorBinding> resolve_colors(const FileInfo& info, const std::string& view, const Profile& profile,
                                         const std::map<std::string, std::string>& overrides,
                                         const std::vector<std::string>& cryptomattes) {
  const ViewChannels channels(info, view);
  std::vector<ColorBinding> out;
  if (auto beauty = find_beauty(channels, profile, overrides)) out.push_back(std::move(*beauty));
  for (const Group& group : groups_of(channels)) {
    if (is_cryptomatte(group.layer, cryptomattes)) continue;
    auto color = as_color(group);
    if (!color) continue;
    const bool known = std::any_of(
        out.begin(), out.end(), [&](const ColorBinding& c) { return c.channels.front() == color->channels.front(); });
    if (!known) out.push_back(std::move(*color));
  }
  return out;
}

ColorBinding find_layer(const FileInfo& info, const std::string& view, const std::vector<ColorBinding>& colors,
                        const std::string& name, const std::vector<std::string>& cryptomattes) {
  const ViewChannels channels(info, view);
  for (const ColorBinding& color : colors) {
    if (color.is_beauty ? name == "beauty" || name.empty() : name == color.layer) return color;
    const std::string full =
        layer_of(name_in_view(info, color.channels[0].part, color.channels[0].channel, view).value_or(""));
    if (color.is_beauty && full == name) return color;
  }
  if (is_cryptomatte(name, cryptomattes) || is_cryptomatte(layer_of(name), cryptomattes)) refuse_cryptomatte(name);
  std::vector<std::string> known{"beauty"};
  for (const Group& group : groups_of(channels)) {
    known.push_back(group.layer);
    if (group.layer != name) continue;
    ColorBinding out{.layer = name, .channels = {}, .alpha = -1, .is_beauty = false};
    for (const NamedChannel& channel : group.channels) out.channels.push_back(channel.ref);
    out.alpha = alpha_of(out.channels);
    return out;
  }
  if (const NamedChannel* channel = channels.find_exact(name))
    return {.layer = name, .channels = {channel->ref}, .alpha = -1, .is_beauty = false};
  for (const std::string& channel : channels.names()) known.push_back(channel);
  const std::string guess = did_you_mean(name, known);
  throw Error(ErrorCode::no_input, cat("there is no layer or channel \"", name, "\""),
              guess.empty() ? "the file has " + channels.listed() : guess);
}

ChannelRef find_channel(const FileInfo& info, const std::string& view, const std::string& name,
                        const std::vector<std::string>& cryptomattes) {
  const ViewChannels channels(info, view);
  const NamedChannel* found = channels.find_exact(name);
  if (!found) {
    const std::string layer = channels_of_layer(channels, name), guess = did_you_mean(name, channels.names());
    throw Error(ErrorCode::no_input, cat("there is no channel \"", name, "\""),
                !layer.empty()  ? "a layer is called so: name one of its channels, " + layer
                : guess.empty() ? "the file has " + channels.listed()
                                : guess);
  }
  for (const NamedChannel& channel : channels.all())
    if (channel.ref == found->ref && is_cryptomatte(layer_of(channel.name), cryptomattes)) refuse_cryptomatte(name);
  return found->ref;
}

}  // namespace aftershade::io
