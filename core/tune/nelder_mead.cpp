#include "core/tune/nelder_mead.h"

#include <algorithm>
#include <cmath>

namespace aftershade::tune {

namespace {

struct Vertex {
  Point at;
  Rank rank;
};

/// a + t (b - a), inside the cube.
Point between(const Point& a, const Point& b, double t) {
  Point out(a.size());
  for (size_t i = 0; i < a.size(); ++i) out[i] = std::clamp(a[i] + t * (b[i] - a[i]), 0.0, 1.0);
  return out;
}

class Simplex {
 public:
  Simplex(const Point& start, const Point& steps, const RankOf& rank) : rank_(rank) {
    add(start);
    for (size_t i = 0; i < start.size(); ++i) {
      Point at = start;
      at[i] = std::clamp(at[i] + steps[i], 0.0, 1.0);
      add(at);
    }
    sort();
  }

  bool ended() const { return ended_; }

  bool is_smaller_than(double tolerance) const {
    for (const Vertex& vertex : vertices_)
      for (size_t i = 0; i < vertex.at.size(); ++i)
        if (std::abs(vertex.at[i] - vertices_.front().at[i]) > tolerance) return false;
    return true;
  }

  /// One iteration of Gao and Han's section 2: reflects the worst vertex, then expands, contracts or shrinks.
  void iterate() {
    const Rank best = vertices_.front().rank, second_worst = vertices_[vertices_.size() - 2].rank,
               worst = vertices_.back().rank;
    const auto reflected = try_at(kReflection);
    if (!reflected) return;
    if (reflected->rank < best) {
      const auto expanded = try_at(kReflection * expansion());
      if (expanded) replace_worst(expanded->rank < reflected->rank ? *expanded : *reflected);
    } else if (reflected->rank < second_worst) {
      replace_worst(*reflected);
    } else {
      const bool outside = reflected->rank < worst;
      const auto contracted = try_at(outside ? kReflection * contraction() : -contraction());
      if (!contracted) return;
      if (outside ? contracted->rank <= reflected->rank : contracted->rank < worst)
        replace_worst(*contracted);
      else
        shrink();
    }
  }

 private:
  static constexpr double kReflection = 1;
  double dimension() const { return std::max<double>(2, static_cast<double>(vertices_.size()) - 1); }
  double expansion() const { return 1 + 2 / dimension(); }
  double contraction() const { return 0.75 - 1 / (2 * dimension()); }
  double shrinkage() const { return 1 - 1 / dimension(); }

  std::optional<Vertex> ranked(Point at) {
    const auto rank = ended_ ? std::nullopt : rank_(at);
    if (!rank) {
      ended_ = true;
      return std::nullopt;
    }
    return Vertex{std::move(at), *rank};
  }

  void add(const Point& at) {
    if (auto vertex = ranked(at)) vertices_.push_back(std::move(*vertex));
  }

  void sort() {
    std::ranges::stable_sort(vertices_, [](const Vertex& a, const Vertex& b) { return a.rank < b.rank; });
  }

  /// The point `t` times as far behind the centre of the other vertices as the worst lies before it.
  std::optional<Vertex> try_at(double t) {
    Point centre(vertices_.front().at.size());
    for (size_t v = 0; v + 1 < vertices_.size(); ++v)
      for (size_t i = 0; i < centre.size(); ++i)
        centre[i] += vertices_[v].at[i] / static_cast<double>(vertices_.size() - 1);
    return ranked(between(centre, vertices_.back().at, -t));
  }

  void replace_worst(Vertex vertex) {
    vertices_.back() = std::move(vertex);
    sort();
  }

  void shrink() {
    for (size_t v = 1; v < vertices_.size(); ++v) {
      auto vertex = ranked(between(vertices_.front().at, vertices_[v].at, shrinkage()));
      if (!vertex) return;
      vertices_[v] = std::move(*vertex);
    }
    sort();
  }

  const RankOf& rank_;
  std::vector<Vertex> vertices_;  ///< the best first
  bool ended_ = false;
};

}  // namespace

void nelder_mead(const Point& start, const Point& steps, double tolerance, const RankOf& rank) {
  Simplex simplex(start, steps, rank);
  while (!simplex.ended() && !simplex.is_smaller_than(tolerance)) simplex.iterate();
}

}  // namespace aftershade::tune
