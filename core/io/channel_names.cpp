#include "core/io/channel_names.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {

bool has_views_in_names(const FileInfo& info) { return info.parts.size() == 1 && !info.multi_view.empty(); }
bool is_view(const FileInfo& info, const std::string& token) {
  return std::find(info.multi_view.begin(), info.multi_view.end(), token) != info.multi_view.end();
}

bool belongs_to_one_view(const FileInfo& info, const ChannelRef& ref) {
  if (!has_views_in_names(info)) return !info.parts[static_cast<size_t>(ref.part)].view.empty();
  const auto tokens = split(ref.channel, '.');
  return tokens.size() == 1 || is_view(info, tokens[tokens.size() - 2]);
}

/// The layer that a part's name stands for: without view and the tokens that say nothing ("depth.main" -> "depth").
std::string layer_of_part(const PartInfo& part) {
  static const std::array<std::string_view, 4> empty_words{"main", "rgb", "rgba", "other"};
  std::vector<std::string> kept;
  for (const std::string& token : split(part.name, '.')) {
    const bool says_nothing = std::find(empty_words.begin(), empty_words.end(), to_lower(token)) != empty_words.end();
    if (!token.empty() && !says_nothing && token != part.view) kept.push_back(token);
  }
  return join(kept, ".");
}

/// What the first `*` of `pattern` stands for in `name`, if the name fits; "" without a star.
std::optional<std::string> star_text(const std::string& pattern, const std::string& name) {
  const size_t star = pattern.find('*');
  if (star == std::string::npos) return glob_match(pattern, name) ? std::optional<std::string>("") : std::nullopt;
  for (size_t length = 0; star + length <= name.size(); ++length) {
    std::string text = name.substr(star, length);
    if (glob_match(pattern.substr(0, star) + text + pattern.substr(star + 1), name)) return text;
  }
  return std::nullopt;
}

std::string with_star(std::string pattern, const std::string& text) {
  const size_t star = pattern.find('*');
  return star == std::string::npos ? pattern : pattern.replace(star, 1, text);
}

}  // namespace

std::string last_token(const std::string& name) { return name.substr(name.rfind('.') + 1); }

std::string layer_of(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

std::vector<std::string> views_of(const FileInfo& info) {
  if (has_views_in_names(info)) return info.multi_view;
  std::vector<std::string> views;
  for (const PartInfo& part : info.parts)
    if (!part.view.empty() && std::find(views.begin(), views.end(), part.view) == views.end())
      views.push_back(part.view);
  if (views.empty()) views.emplace_back();
  return views;
}

std::optional<std::string> name_in_view(const FileInfo& info, int part, const std::string& channel,
                                        const std::string& view) {
  if (!has_views_in_names(info)) {
    const std::string& owner = info.parts[static_cast<size_t>(part)].view;
    return owner.empty() || owner == view ? std::optional(channel) : std::nullopt;
  }
  auto tokens = split(channel, '.');
  if (tokens.size() == 1) return view == info.multi_view.front() ? std::optional(channel) : std::nullopt;
  const auto owner = tokens.end() - 2;
  if (!is_view(info, *owner)) return channel;
  if (*owner != view) return std::nullopt;
  tokens.erase(owner);
  return join(tokens, ".");
}

std::string name_for_view(const FileInfo& info, const std::string& name, const std::string& view) {
  if (!has_views_in_names(info)) return name;
  auto tokens = split(name, '.');
  if (tokens.size() == 1 && view == info.multi_view.front()) return name;
  tokens.insert(tokens.end() - 1, view);
  return join(tokens, ".");
}

ViewChannels::ViewChannels(const FileInfo& info, const std::string& view) {
  for (size_t part = 0; part < info.parts.size(); ++part) {
    const std::string layer = info.parts.size() > 1 ? layer_of_part(info.parts[part]) : "";
    for (const ChannelInfo& channel : info.parts[part].channels) {
      const ChannelRef ref{static_cast<int>(part), channel.name};
      const auto name = name_in_view(info, ref.part, channel.name, view);
      if (!name) continue;
      channels_.push_back({ref, *name});
      if (!layer.empty() && name->find('.') == std::string::npos) channels_.push_back({ref, layer + "." + *name});
    }
  }
  std::stable_partition(channels_.begin(), channels_.end(),
                        [&](const NamedChannel& c) { return belongs_to_one_view(info, c.ref); });
}

std::vector<std::string> ViewChannels::names() const {
  std::vector<std::string> out;
  for (const NamedChannel& channel : channels_) out.push_back(channel.name);
  return out;
}

std::string ViewChannels::listed() const {
  constexpr size_t kMost = 20;
  std::vector<std::string> out = names();
  const size_t more = out.size() > kMost ? out.size() - kMost : 0;
  out.resize(out.size() - more);
  return join(out, ", ") + (more ? cat(" and ", more, " more") : "");
}

const NamedChannel* ViewChannels::find(std::string_view pattern, int part) const {
  const NamedChannel* found = nullptr;
  for (const NamedChannel& channel : channels_) {
    if (part >= 0 && channel.ref.part != part) continue;
    if (channel.name == pattern) return &channel;
    if (!found && glob_match(pattern, channel.name)) found = &channel;
  }
  return found;
}

const NamedChannel* ViewChannels::find_exact(std::string_view name) const {
  for (const NamedChannel& channel : channels_)
    if (channel.name == name) return &channel;
  for (const NamedChannel& channel : channels_)
    if (channel.ref.channel == name) return &channel;
  return nullptr;
}

bool ViewChannels::matches(const ChannelRef& ref, std::string_view pattern) const {
  return std::any_of(channels_.begin(), channels_.end(), [&](const NamedChannel& channel) {
    return channel.ref.part == ref.part && channel.ref.channel == ref.channel && glob_match(pattern, channel.name);
  });
}

std::optional<std::vector<ChannelRef>> ViewChannels::bind(const std::vector<std::string>& patterns, size_t required,
                                                          const std::function<bool(const NamedChannel&)>& usable,
                                                          bool one_part) const {
  for (const bool identical : {true, false})
    for (const NamedChannel& first : channels_) {
      const auto star = star_text(patterns.front(), first.name);
      if (!star || (with_star(patterns.front(), *star) == first.name) != identical || !usable(first)) continue;
      std::vector<ChannelRef> refs{first.ref};
      for (size_t i = 1; i < patterns.size(); ++i) {
        const NamedChannel* found = find(with_star(patterns[i], *star), first.ref.part);
        if (!found && !one_part) found = find(with_star(patterns[i], *star), -1);
        if (!found) break;
        refs.push_back(found->ref);
      }
      if (refs.size() >= required) return refs;
    }
  return std::nullopt;
}

std::vector<ChannelRef> ViewChannels::overridden(std::string_view role, const std::string& names) const {
  std::vector<ChannelRef> refs;
  for (const std::string& name : split(names, ',')) {
    const NamedChannel* found = find_exact(name);
    if (!found) {
      const std::string guess = did_you_mean(name, this->names());
      throw Error(ErrorCode::no_input, cat("channel \"", name, "\" of --channel ", role, "=", names, " does not exist"),
                  guess.empty() ? "the file has " + listed() : guess);
    }
    refs.push_back(found->ref);
  }
  return refs;
}

}  // namespace aftershade::io
