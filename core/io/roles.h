#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/image/role.h"
#include "core/io/profile.h"

namespace aftershade::io {

/// A channel found in a file: part index and full name.
struct ChannelRef {
  int part;
  std::string channel;
  bool operator==(const ChannelRef&) const = default;
};

/// Where a role's planes come from, and why.
struct RoleBinding {
  Role role;
  std::vector<ChannelRef> channels;
  Encoding encoding;
  std::string why;  ///< "profile blender: *.Depth.Z", "--channel depth=foo.Z", "--role depth=..."
  int sibling =
      -1;  ///< index of the sibling sequence that holds it (FileSourceOptions::siblings), or -1: the file itself
};

struct ColorBinding {
  std::string layer;                 ///< "" for the beauty
  std::vector<ChannelRef> channels;  ///< R G B [A] or any set; in one part
  int alpha = -1;
  bool is_beauty = false;
};

/// The views of a file: multiView, or the parts' view attributes; {""} when there are none.
std::vector<std::string> views_of(const FileInfo& info);

/// `channel` without its view token ("forward.left.u" -> "forward.u" for view "left"); nullopt when the channel belongs
/// to another view.
std::optional<std::string> name_in_view(const FileInfo& info, int part, const std::string& channel,
                                        const std::string& view);

/// The roles of a view: user overrides first ("depth" -> "foo.Z", comma lists for roles of several planes), else the
/// profile's candidates in order. A `*.Z` beside X and Y is a vector's component and never a depth. Throws
/// Error(no_input) when an override names a channel that does not exist (with the nearest name), Error(usage) for an
/// unknown role (the key "color" is resolve_colors' own).
std::vector<RoleBinding> resolve_roles(const FileInfo& info, const std::string& view, const Profile& profile,
                                       const std::map<std::string, std::string>& overrides);

/// The beauty (profile's colour candidates, or the override "color" -> "foo.R,foo.G,foo.B"), and the other layers that
/// hold colour: groups of channels with the same prefix and part whose suffixes are R G B [A] (any case, also red green
/// blue alpha). Cryptomatte layers, by the names of the header or by custom, are no colour.
std::vector<ColorBinding> resolve_colors(const FileInfo& info, const std::string& view, const Profile& profile,
                                         const std::map<std::string, std::string>& overrides = {},
                                         const std::vector<std::string>& cryptomattes = {});

/// The layer that a user names: "beauty", one of `colors`, any group of channels, or one channel. Error(no_input) with
/// the nearest name; Error(usage) for a Cryptomatte.
ColorBinding find_layer(const FileInfo& info, const std::string& view, const std::vector<ColorBinding>& colors,
                        const std::string& name, const std::vector<std::string>& cryptomattes = {});

/// The one channel that a preset names, by its name in the view or its full name in the file. Error(no_input) with the
/// nearest name, or the channels of the layer that is called so; Error(usage) for a Cryptomatte's.
ChannelRef find_channel(const FileInfo& info, const std::string& view, const std::string& name,
                        const std::vector<std::string>& cryptomattes = {});

/// The names of the Cryptomattes that a file's headers declare.
std::vector<std::string> cryptomatte_names(const ExrReader& file);

}  // namespace aftershade::io
