#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/source_state.h"

namespace aftershade::io {

Window data_window(const ExrReader& file, int part) {
  return file.info().parts.at(static_cast<size_t>(part)).data_window;
}

void PlaneReader::add(const ExrReader& file, const ChannelRef& ref, Plane& target, float outside,
                      bool infinity_is_meant) {
  jobs_.push_back({&file, ref, &target, outside, infinity_is_meant});
}

namespace {
/// A plane whose pixels inside of `data` will be written by somebody else.
Plane make_plane(Window window, Window data, float outside) {
  if (intersection(window, data) == window) return Plane::for_overwrite(window.width(), window.height());
  return {window.width(), window.height(), outside};
}
}  // namespace

NanReport PlaneReader::read(Window window, bool nan_is_error, const ExrReader* kept_file, PackedParts* keep) const {
  std::vector<NotNumbers> found(jobs_.size());
  std::map<std::pair<const ExrReader*, int>, std::vector<ExrReader::Request>> parts;
  for (size_t i = 0; i < jobs_.size(); ++i) {
    const Job& job = jobs_[i];
    *job.target = make_plane(window, data_window(*job.file, job.ref.part), job.outside);
    parts[{job.file, job.ref.part}].push_back({job.ref.channel, job.target->view(), &found[i]});
  }
  for (const auto& [part, requests] : parts) {
    const auto [file, index] = part;
    if (file == kept_file && keep != nullptr && keep->contains(index))
      (*keep)[index] = file->read_and_keep(index, requests, window);
    else
      file->read(index, requests, window);
  }
  return report(found, nan_is_error);
}

NanReport PlaneReader::report(const std::vector<NotNumbers>& found, bool nan_is_error) const {
  NanReport report;
  for (size_t i = 0; i < jobs_.size(); ++i) {
    const Job& job = jobs_[i];
    const int64_t infinite = job.infinity_is_meant ? 0 : found[i].infinite;
    if (nan_is_error && found[i].nan + infinite > 0)
      throw Error(ErrorCode::data,
                  cat("channel ", job.ref.channel, " of ", job.file->info().path, " has ", found[i].nan, " NaN and ",
                      infinite, " infinite pixels"),
                  "without --nan error they are left out of filters");
    if (found[i].nan) report.nan[job.ref.channel] = found[i].nan;
    if (infinite) report.infinite[job.ref.channel] = infinite;
  }
  return report;
}

}  // namespace aftershade::io
