#include <algorithm>
#include <numeric>
#include <string_view>

#include "core/base/embedded.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/report/comparison.h"
#include "core/report/json.h"
#include "core/report/page_pictures.h"

namespace aftershade::page {
std::span<const EmbeddedFile> embedded_files();  // core/report/page/*, written by the build
}  // namespace aftershade::page

namespace aftershade::report {

namespace {

using params::Json;

/// Modules in the order of the script: each uses only those before it.
constexpr std::string_view kScripts[] = {"data",     "marks",  "axes",   "results",    "chart", "frames",
                                         "pictures", "canvas", "viewer", "parameters", "main"};
constexpr int kMostHalvings = 4;
constexpr size_t kFewFrames = 3;  ///< with fewer than these (if there are so many) pictures get smaller

std::string_view page_file(std::string_view name) {
  for (const EmbeddedFile& file : page::embedded_files())
    if (file.name == name) return file.text;
  throw Error(ErrorCode::internal, cat("the page's file ", name, " is missing"));
}

/// For the inside of a script element: nothing in it can end the element.
std::string harmless(std::string json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// What the parameters of the methods that occur mean: method -> key -> sentence.
Json parameter_docs(const Comparison& comparison) {
  Json docs = Json::object();
  for (const Candidate& candidate : comparison.candidates)
    for (const preset::StageDescription& stage : candidate.preset.stages)
      for (const params::Record& record : preset::table_of(stage.params))
        docs[std::string(preset::method_of(stage.params))][record.key] = record.doc;
  return docs;
}

/// The template with its marks {{name}} replaced; the parts are not searched for marks.
std::string filled(std::string_view text, const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
  std::string out;
  while (!text.empty()) {
    const size_t open = text.find("{{");
    out += text.substr(0, open);
    if (open == std::string_view::npos) break;
    const size_t close = text.find("}}", open);
    const std::string_view mark = text.substr(open + 2, close - open - 2);
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == mark; });
    if (part == parts.end()) throw Error(ErrorCode::internal, cat("the page has no part ", mark));
    out += part->second;
    text.remove_prefix(close + 2);
  }
  return out;
}

std::string page_with(const Comparison& comparison, const std::vector<std::string>& notes, const std::string& shown) {
  Json data = json_of(comparison);
  data.erase("shown");
  for (const std::string& note : notes) data["notes"].push_back(note);
  data["docs"] = parameter_docs(comparison);
  std::string script;
  for (const std::string_view name : kScripts) script += page_file(name);
  const std::string title = escaped(Json::parse(dumped(comparison.input)).get<std::string>());  // UTF-8 for sure
  const std::string text = harmless(dumped(data)), pictures = harmless("[" + shown + "]");
  return filled(page_file("page"), {{"title", std::string_view(title)},
                                    {"style", page_file("style")},
                                    {"data", text},
                                    {"shown", pictures},
                                    {"script", script}});
}

/// The texts of as many frames as fit into `room` bytes, the worst first; by number.
std::vector<std::string> fitting(const std::vector<ShownFrame>& frames, size_t first, int halvings, size_t room) {
  std::vector<size_t> worst(frames.size());
  std::iota(worst.begin(), worst.end(), size_t{0});
  std::stable_sort(worst.begin(), worst.end(), [&](size_t a, size_t b) { return frames[a].error > frames[b].error; });
  std::vector<std::pair<size_t, std::string>> texts;
  size_t bytes = 0;
  for (const size_t i : worst) {
    std::string text = shown_text(smaller(frames[i], halvings), first);
    bytes += text.size() + 1;
    if (bytes > room) break;
    texts.emplace_back(i, std::move(text));
  }
  std::sort(texts.begin(), texts.end());
  std::vector<std::string> out;
  for (auto& [index, text] : texts) out.push_back(std::move(text));
  return out;
}

std::string megabytes(size_t bytes) { return cat(fixed(static_cast<double>(bytes) / (1 << 20), 1), " MB"); }

std::vector<std::string> notes_on(size_t kept, size_t all, int halvings, size_t budget_bytes) {
  std::vector<std::string> notes;
  if (kept < all)
    notes.push_back(cat("the page shows pictures of ", kept == 0 ? "none" : cat(kept), " of the ", all,
                        " worst frames: more do not fit into ", megabytes(budget_bytes)));
  if (halvings > 0 && kept > 0)
    notes.push_back(
        cat("the page's pictures are made ", 1 << halvings, " times smaller to fit into ", megabytes(budget_bytes)));
  return notes;
}

}  // namespace

std::string page_text(const Comparison& comparison, size_t budget_bytes, std::vector<std::string>& notes) {
  constexpr size_t kRoomForNotes = 1024;
  const size_t bare = page_with(comparison, {}, "").size() + kRoomForNotes;
  if (bare > budget_bytes)
    throw Error(ErrorCode::usage,
                cat("a page without pictures needs ", megabytes(bare), ", more than the ", megabytes(budget_bytes),
                    " it may have"),
                "allow a larger page, or compare fewer frames");
  const std::vector<ShownFrame>& frames = comparison.shown;
  // The reference's picture, which candidates resemble, else the first candidate's.
  const size_t first = comparison.reference.empty() ? 0 : comparison.candidates.size();
  const size_t enough = std::min(kFewFrames, frames.size());
  std::vector<std::string> texts;
  int halvings = 0;
  for (;; ++halvings) {
    texts = fitting(frames, first, halvings, budget_bytes - bare);
    if (texts.size() >= enough || halvings == kMostHalvings) break;
  }
  const std::vector<std::string> own = notes_on(texts.size(), frames.size(), halvings, budget_bytes);
  notes.insert(notes.end(), own.begin(), own.end());
  return page_with(comparison, own, join(texts, ","));
}

}  // namespace aftershade::report
