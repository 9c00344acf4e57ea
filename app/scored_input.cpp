#include "app/scored_input.h"

#include <algorithm>
#include <limits>

#include "app/log.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/placed.h"
#include "core/temporal/reprojection.h"

namespace aftershade::app {

namespace {

bool names_ao(const InputArgs& args) {
  return std::any_of(args.channels.begin(), args.channels.end(),
                     [](const std::string& text) { return text.starts_with("ao="); });
}

Frame load(const Input& input, const std::string& view, int number, RoleSet roles, bool layers) {
  auto frame = input.source->load(number, view, roles, layers);
  if (!frame)
    throw Error(ErrorCode::no_input, cat("frame ", number, " of ", input.found.pattern.text(), " is missing"));
  return std::move(*frame);
}

Plane shown(const Plane& plane, const Frame& frame, float background) {
  if (frame.window == frame.display) return plane.shared();
  return placed(plane, frame.window, frame.display, background);
}

/// What a metric lacks; "" when it can be computed.
std::string lacking(const metrics::MetricInfo& metric, const Scorable& scorable) {
  if (metric.reference && !scorable.reference) return "a reference";
  if (metric.of_ao && !scorable.ao) return "an AO channel on both sides";
  if (!metric.of_ao && !scorable.color) return "colour channels on both sides";
  if (metric.moving && !scorable.moving) return "depth, vectors and cameras with a position";
  if (metric.temporal && !scorable.motion) return "depth, and vectors or cameras with a position";
  return "";
}

}  // namespace

ScoredSide open_scored_side(InputArgs args) {
  ScoredSide side{open_input(args), "", false, false};
  side.view = side.input.views.front();
  if (side.input.views.size() > 1)
    log().note(cat(args.input, " has several views: view ", side.view, " is scored"), args.input + ": ");
  for (const std::string name : {kOwnAoChannel, "AO"}) {
    if (names_ao(args) || !has_channel(side.input.source->info(), side.view, name)) continue;
    args.channels.push_back("ao=" + name);
    side.input = open_input(args);
    break;
  }
  side.ao = side.input.source->available(side.view).contains(Role::ao);
  const auto& layers = side.input.source->layers(side.view);
  side.color = std::any_of(layers.begin(), layers.end(), [](const auto& layer) { return layer.is_beauty; });
  return side;
}

SidePlanes side_planes(const Frame& frame, const Plane& ao, const std::string& path) {
  SidePlanes out{path, frame.display, {}, {}};
  for (const Layer& layer : frame.layers)
    for (size_t c = 0; layer.is_beauty && c < 3; ++c) out.color[c] = shown(layer.planes.at(c), frame, 0);
  if (!ao.empty()) out.ao = shown(ao, frame, 1);
  return out;
}

SidePlanes load_side(const ScoredSide& side, int number, bool color, bool ao) {
  const Frame frame = load(side.input, side.view, number, ao ? RoleSet{Role::ao} : RoleSet{}, color);
  return side_planes(frame, frame.has(Role::ao) ? frame.planes(Role::ao)[0].shared() : Plane(),
                     *side.input.found.sequence.path(number));
}

void add_geometry(const Input& input, const std::string& view, Scorable& scorable) {
  const pipeline::Offer offer = offer_of(input, view);
  if (!offer.roles.contains(Role::depth)) return;
  const bool vectors = offer.roles.contains(Role::velocity_prev) || offer.roles.contains(Role::velocity_next);
  scorable.motion = vectors || offer.position;
  scorable.moving = vectors && offer.position;
}

std::vector<std::string> metrics_to_score(const std::vector<std::string>& asked, const Scorable& scorable) {
  metrics::SequenceScorer check(asked);  // unknown names
  std::vector<std::string> names;
  for (const metrics::MetricInfo& metric : metrics::metric_infos()) {
    const std::string missing = lacking(metric, scorable);
    const bool wanted = std::find(asked.begin(), asked.end(), metric.name) != asked.end();
    if (wanted && !missing.empty())
      throw Error(
          ErrorCode::no_input, cat("metric ", metric.name, " needs ", missing),
          metric.temporal && missing.starts_with("depth")
              ? "--geometry takes depth and vectors from another sequence"
              : "aftershade inspect shows what was recognised; --channel and --reference-channel name channels");
    if (wanted || (asked.empty() && missing.empty())) names.emplace_back(metric.name);
  }
  if (names.empty())
    throw Error(ErrorCode::no_input, "there is nothing to score: the sequences have neither colour nor AO in common",
                "--channel and --reference-channel name channels");
  return names;
}

GeometryPlanes geometry_of(const Frame& frame, const Frame* before) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  GeometryPlanes out{
      frame.display, shown(frame.depth(), frame, std::numeric_limits<float>::infinity()), {}, {}, frame.camera};
  if (frame.has(Role::velocity_prev)) {
    out.velocity_x = shown(frame.planes(Role::velocity_prev)[0], frame, kUnknown);
    out.velocity_y = shown(frame.planes(Role::velocity_prev)[1], frame, kUnknown);
  } else if (before && before->has(Role::velocity_next)) {
    const auto& next = before->planes(Role::velocity_next);
    auto carried = temporal::scatter_velocity(next[0], next[1], before->depth(), before->window, frame.window);
    out.velocity_x = shown(carried.x, frame, kUnknown);
    out.velocity_y = shown(carried.y, frame, kUnknown);
  }
  return out;
}

GeometryPlanes load_geometry(const Input& input, const std::string& view, int number) {
  const RoleSet offered = input.source->available(view);
  const Frame frame = load(input, view, number, {Role::depth, Role::velocity_prev}, false);
  std::optional<Frame> before;
  if (!offered.contains(Role::velocity_prev) && offered.contains(Role::velocity_next) &&
      input.found.sequence.path(number - 1))
    before = load(input, view, number - 1, {Role::depth, Role::velocity_next}, false);
  return geometry_of(frame, before ? &*before : nullptr);
}

metrics::ScoredFrame scored_frame(int number, const SidePlanes& result, const SidePlanes* reference,
                                  const GeometryPlanes* geometry, const Plane& mask) {
  const auto check = [&](int width, int height, const std::string& other) {
    if (width == result.display.width() && height == result.display.height()) return;
    throw Error(ErrorCode::data,
                cat("frame ", number, ": ", result.path, " is ", result.display.width(), "x", result.display.height(),
                    ", ", other, " is ", width, "x", height),
                "display windows must have the same size");
  };
  metrics::ScoredFrame out;
  out.number = number;
  out.color = result.rgb();
  out.ao = result.ao;
  out.origin_x = result.display.min_x;
  out.origin_y = result.display.min_y;
  if (reference) {
    check(reference->display.width(), reference->display.height(), reference->path);
    out.true_color = reference->rgb();
    out.true_ao = reference->ao;
  }
  if (geometry) {
    check(geometry->display.width(), geometry->display.height(), "the frame of depth and vectors");
    out.depth = geometry->depth;
    out.velocity_x = geometry->velocity_x;
    out.velocity_y = geometry->velocity_y;
    out.camera = geometry->camera;
    out.origin_x = geometry->display.min_x;
    out.origin_y = geometry->display.min_y;
  }
  if (!mask.empty()) {
    check(mask.width(), mask.height(), "the mask");
    out.mask = mask;
  }
  return out;
}

}  // namespace aftershade::app
