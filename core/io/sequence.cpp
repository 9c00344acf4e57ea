#include "core/io/sequence.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {

constexpr int64_t kMaxFrames = 10'000'000;  // more than any shot; keeps a typing error from filling the memory

/// The integer at the start of `rest`, which moves behind it.
std::optional<int> take_integer(std::string_view& rest) {
  int value = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc{}) return std::nullopt;
  rest.remove_prefix(static_cast<size_t>(end - rest.data()));
  return value;
}

struct Range {
  int first, last, step;
};

std::optional<Range> parse_range(std::string_view piece) {
  const auto first = take_integer(piece);
  if (!first) return std::nullopt;
  if (piece.empty()) return Range{*first, *first, 1};
  if (piece.front() != '-') return std::nullopt;
  piece.remove_prefix(1);
  const auto last = take_integer(piece);
  if (!last) return std::nullopt;
  if (piece.empty()) return Range{*first, *last, *first <= *last ? 1 : -1};
  if (piece.front() != 'x' && piece.front() != ':') return std::nullopt;
  piece.remove_prefix(1);
  const auto step = take_integer(piece);
  if (!step || *step <= 0 || !piece.empty()) return std::nullopt;
  return Range{*first, *last, *first <= *last ? *step : -*step};
}

void sort_unique(FrameNumbers& frames) {
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
}

/// Index behind the longest run of equal steps that starts at `i`.
size_t run_end(const FrameNumbers& frames, size_t i) {
  size_t end = i + 1;
  while (end < frames.size() &&
         (end == i + 1 || int64_t{frames[end]} - frames[end - 1] == int64_t{frames[i + 1]} - frames[i]))
    ++end;
  return end;
}

}  // namespace

FrameNumbers parse_frames(std::string_view text) {
  FrameNumbers frames;
  for (const std::string& piece : split(text, ',')) {
    const auto range = parse_range(piece);
    if (!range)
      throw Error(ErrorCode::usage, cat("\"", piece, "\" is not a frame range"),
                  "write 1001, 1001-1100, 1001-1100x2 or a list such as 1-9,20");
    const int64_t count = (int64_t{range->last} - range->first) / range->step + 1;
    if (count + static_cast<int64_t>(frames.size()) > kMaxFrames)
      throw Error(ErrorCode::usage, cat("\"", piece, "\" names more than ", kMaxFrames, " frames"));
    for (int64_t i = 0; i < count; ++i) frames.push_back(static_cast<int>(range->first + i * range->step));
  }
  sort_unique(frames);
  return frames;
}

std::string format_frames(const FrameNumbers& frames) {
  std::vector<std::string> pieces;
  for (size_t i = 0; i < frames.size();) {
    const size_t end = run_end(frames, i);
    if (end - i < 3) {
      pieces.push_back(cat(frames[i++]));
      continue;
    }
    const int64_t step = int64_t{frames[i + 1]} - frames[i];
    pieces.push_back(cat(frames[i], '-', frames[end - 1], step == 1 ? "" : cat('x', step)));
    i = end;
  }
  return join(pieces, ",");
}

Sequence::Sequence(std::vector<Entry> entries) : entries_(std::move(entries)) {
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.frame < b.frame; });
  entries_.erase(
      std::unique(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.frame == b.frame; }),
      entries_.end());
}

const std::string* Sequence::path(int frame) const {
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), frame, [](const Entry& e, int f) { return e.frame < f; });
  return found != entries_.end() && found->frame == frame ? &found->path : nullptr;
}

FrameNumbers Sequence::frames() const {
  FrameNumbers out;
  for (const Entry& entry : entries_) out.push_back(entry.frame);
  return out;
}

FrameNumbers Sequence::holes() const {
  int64_t step = INT64_MAX;
  for (size_t i = 1; i < entries_.size(); ++i)
    step = std::min(step, int64_t{entries_[i].frame} - entries_[i - 1].frame);
  FrameNumbers out;
  for (size_t i = 1; i < entries_.size(); ++i)
    for (int64_t f = entries_[i - 1].frame + step; f < entries_[i].frame; f += step) {
      if (static_cast<int64_t>(out.size()) == kMaxFrames) return out;
      out.push_back(static_cast<int>(f));
    }
  return out;
}

}  // namespace aftershade::io
