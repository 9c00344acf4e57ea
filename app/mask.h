#pragma once
#include <optional>
#include <string>

#include "app/job.h"
#include "core/io/cryptomatte.h"

namespace aftershade::app {

/// Where scores count, as --mask names it: "alpha" (the beauty's), "cryptomatte:NAME", "cryptomatte:LAYER/NAME"
/// (io::find_cryptomatte), or a channel.
class MaskReader {
 public:
  /// Looks in the sequence's first chosen frame. Throws Error(usage, no_input) for what is not there.
  MaskReader(const std::string& spec, const Input& input, const std::string& view);
  /// The frame's values in its display window; scores count above 0.5. 0 where the file has no pixel.
  Plane load(int frame) const;

 private:
  Plane read(int frame) const;

  io::Sequence sequence_;
  std::string view_;
  std::optional<io::ChannelRef> channel_;
  std::optional<std::string> object_;  ///< of a Cryptomatte
};

}  // namespace aftershade::app
