#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/source_state.h"

namespace aftershade::io {

namespace {

struct Count {
  int64_t nan = 0, infinite = 0;
};

/// Pixels of `inside` that are no finite numbers; the plane covers `window`.
Count count_bad(const Plane& plane, Window window, Window inside) {
  Count count;
  for (int y = inside.min_y; y <= inside.max_y; ++y) {
    const float* row = plane.row(y - window.min_y) - window.min_x;
    for (int x = inside.min_x; x <= inside.max_x; ++x) {
      count.nan += std::isnan(row[x]) ? 1 : 0;
      count.infinite += std::isinf(row[x]) ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

Window data_window(const ExrReader& file, int part) {
  return file.info().parts.at(static_cast<size_t>(part)).data_window;
}

void PlaneReader::add(const ExrReader& file, const ChannelRef& ref, Plane& target, bool infinity_is_meant) {
  jobs_.push_back({&file, ref, &target, infinity_is_meant});
}

NanReport PlaneReader::read(Window window, bool nan_is_error) const {
  std::map<std::pair<const ExrReader*, int>, std::vector<ExrReader::Request>> parts;
  for (const Job& job : jobs_) parts[{job.file, job.ref.part}].push_back({job.ref.channel, job.target->view()});
  for (const auto& [part, requests] : parts) part.first->read(part.second, requests, window);
  NanReport report;
  for (const Job& job : jobs_) {
    const Count count = count_bad(*job.target, window, intersection(window, data_window(*job.file, job.ref.part)));
    const int64_t infinite = job.infinity_is_meant ? 0 : count.infinite;
    if (nan_is_error && count.nan + infinite > 0)
      throw Error(ErrorCode::data,
                  cat("channel ", job.ref.channel, " of ", job.file->info().path, " has ", count.nan, " NaN and ",
                      infinite, " infinite pixels"),
                  "without --nan error they are left out of filters");
    if (count.nan) report.nan[job.ref.channel] = count.nan;
    if (infinite) report.infinite[job.ref.channel] = infinite;
  }
  return report;
}

}  // namespace aftershade::io
