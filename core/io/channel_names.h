#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/exr_reader.h"
#include "core/io/roles.h"

namespace aftershade::io {

/// A channel of a view under a name without view token. In a multi-part file a bare channel ("Z" in part "depth.main")
/// is listed a second time with the part's layer in front ("depth.Z"), as Nuke means it.
struct NamedChannel {
  ChannelRef ref;
  std::string name;
};

/// What one view of a file offers, channels of the view before those common to all views.
class ViewChannels {
 public:
  ViewChannels(const FileInfo& info, const std::string& view);
  const std::vector<NamedChannel>& all() const { return channels_; }
  std::vector<std::string> names() const;
  std::string listed() const;  ///< the first names, for messages

  /// The channel that fits a name pattern, identical spelling first; in `part` unless that is -1.
  const NamedChannel* find(std::string_view pattern, int part) const;
  /// By its name in the view or its full name in the file.
  const NamedChannel* find_exact(std::string_view name) const;
  bool matches(const ChannelRef& ref, std::string_view pattern) const;

  /// Channels for `patterns`, in their order: the first `*` stands for the same text in all of them. At least the first
  /// `required` ones must be there. `usable` decides about the first channel; identical spelling goes first.
  std::optional<std::vector<ChannelRef>> bind(const std::vector<std::string>& patterns, size_t required,
                                              const std::function<bool(const NamedChannel&)>& usable,
                                              bool one_part) const;
  /// The channels that --channel `role`=`names` means; Error(no_input) with the nearest name.
  std::vector<ChannelRef> overridden(std::string_view role, const std::string& names) const;

 private:
  std::vector<NamedChannel> channels_;
};

std::string last_token(const std::string& name);  ///< "Z" of "foo.Z" and of "Z"
std::string layer_of(const std::string& name);    ///< "foo" of "foo.Z", "" of "Z"

/// The name of a new channel in a file: with the view token before its last one where the file needs it
/// (conventions 1.1).
std::string name_for_view(const FileInfo& info, const std::string& name, const std::string& view);

}  // namespace aftershade::io
