#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade::io {

/// Frame numbers, sorted, each once; may be negative.
using FrameNumbers = std::vector<int>;

/// "1001-1100", "1001-1100x2" (also ":2"), "-10--1", "1,5,7-9": throws Error(usage) with the offending piece.
FrameNumbers parse_frames(std::string_view text);
/// A short text that parse_frames reads back: "1001-1100x2,1200".
std::string format_frames(const FrameNumbers& frames);

/// What one `#` stands for: one digit (Nuke, Blender, Gaffer), or OpenImageIO's four.
enum class HashDigits { one, oiio };

/// A file name with a place for the frame number. Understood: runs of # or @, %d and %04d, $F and $F4, and an inline
/// range before the token (shot.1001-1100#.exr). Only the file name is searched, never the folder.
struct Pattern {
  std::string folder;  ///< "." when none was given
  std::string prefix{}, suffix{};
  int padding = 1;  ///< least number of digits; the sign is extra
  std::optional<FrameNumbers> range{};
  bool has_token = true;  ///< false: a literal name without any frame number; its frame is 0
  std::string path(int frame) const;
  std::string name(int frame) const;                   ///< without folder
  std::string path_of(const std::string& name) const;  ///< a name found on disk may pad a negative number otherwise
  std::string text() const;                            ///< for messages: folder/prefix####suffix
};

/// A pattern written by a user; nullopt when there is no frame token in the file name. The last token counts.
std::optional<Pattern> parse_pattern(std::string_view text, HashDigits hash);
/// The pattern of a literal frame: the last run of digits before the extension ("shot.1001.exr", "shot_v2.-5.exr"); a
/// version or a size
/// ("_v2", "4k") is not one. Its padding is the number of digits.
std::optional<Pattern> pattern_of_frame(std::string_view path);
/// The frame number of a file name under a pattern, if it matches: at least `padding` digits, no zeros beyond them.
std::optional<int> frame_of_name(const Pattern& pattern, std::string_view name);

/// Frames and their paths, ordered by number; pure data, no disk.
class Sequence {
 public:
  struct Entry {
    int frame;
    std::string path;
  };
  Sequence() = default;
  explicit Sequence(std::vector<Entry> entries);
  const std::vector<Entry>& entries() const { return entries_; }
  bool empty() const { return entries_.empty(); }
  const std::string* path(int frame) const;  ///< nullptr when there is no such frame
  FrameNumbers frames() const;
  /// Numbers between first and last that are missing, in steps of the smallest distance; the first 10 million of them.
  FrameNumbers holes() const;

 private:
  std::vector<Entry> entries_;
};

/// What the user named as INPUT, found on disk.
struct FoundSequence {
  Pattern pattern;
  Sequence sequence;  ///< every frame on disk that fits the pattern, whatever `range` says
};

/// INPUT is a pattern, a literal frame (its sequence is found beside it), or a folder that holds one EXR sequence.
/// Throws Error(no_input) when there is nothing, and when a folder holds several sequences (they are listed).
FoundSequence find_sequence(const std::string& input, HashDigits hash);

}  // namespace aftershade::io
