// Stores vertices in a grid of cells about as wide as an edge is long; each edge searches the cells that it crosses.
#include "bake/place/split_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/math/hash.h"

namespace lobelia {
namespace {

struct Point {
    double x = 0, y = 0, z = 0;
};
Point point(Vec3 v) { return {v.x, v.y, v.z}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point along(Point a, Point d, double t) { return {a.x + d.x * t, a.y + d.y * t, a.z + d.z * t}; }

double length_of(const World& world, const EdgePiece& piece) {
    const Point d = point(world.positions[piece.high]) - point(world.positions[piece.low]);
    return std::sqrt(dot(d, d));
}

/// The ends of the pieces, sorted by cell.
class VertexGrid {
  public:
    VertexGrid(const World& world, std::span<const EdgePiece> pieces, double width) : width_(width) {
        for (const EdgePiece& piece : pieces)
            for (const std::uint32_t v : {piece.low, piece.high}) {
                const Point p = point(world.positions[v]);
                entries_.push_back({key(cell(p.x), cell(p.y), cell(p.z)), v});
            }
        std::sort(entries_.begin(), entries_.end());
        entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
    }

    /// Calls visit(vertex) for all vertices in cells that the box about a and b, grown by `margin`, touches, and
    /// possibly for others; stops when it returns false.
    template <class Visit>
    bool visit_near(Point a, Point b, double margin, const Visit& visit) const {
        const auto range = [&](double u, double v) {
            return std::pair(cell(std::min(u, v) - margin), cell(std::max(u, v) + margin));
        };
        const auto [x0, x1] = range(a.x, b.x);
        const auto [y0, y1] = range(a.y, b.y);
        const auto [z0, z1] = range(a.z, b.z);
        for (std::int64_t z = z0; z <= z1; ++z)
            for (std::int64_t y = y0; y <= y1; ++y)
                for (std::int64_t x = x0; x <= x1; ++x)
                    if (!visit_cell(key(x, y, z), visit)) return false;
        return true;
    }

  private:
    using Entry = std::pair<std::uint64_t, std::uint32_t>;
    [[nodiscard]] std::int64_t cell(double x) const {
        return static_cast<std::int64_t>(std::clamp(std::floor(x / width_), -0x1p52, 0x1p52));
    }
    static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) { return hash_of(std::array{x, y, z}); }
    template <class Visit>
    bool visit_cell(std::uint64_t of_cell, const Visit& visit) const {
        for (auto at = std::lower_bound(entries_.begin(), entries_.end(), Entry{of_cell, 0});
             at != entries_.end() && at->first == of_cell; ++at)
            if (!visit(at->second)) return false;
        return true;
    }

    double width_;
    std::vector<Entry> entries_;
};

/// Splits one piece after another, within limits for all together.
class Splitter {
  public:
    Splitter(const World& world, std::span<const EdgePiece> pieces, double tolerance)
        : world_(&world),
          tolerance_(tolerance),
          width_(cell_width(world, pieces, tolerance)),
          grid_(world, pieces, width_),
          tests_left_(1024 + 512 * pieces.size()),
          cuts_left_(1024 + 4 * pieces.size()) {}

    void split(const EdgePiece& piece, std::vector<EdgePiece>& out) {
        find_cuts(piece);
        if (cuts_.size() > cuts_left_) cuts_.clear();
        cuts_left_ -= cuts_.size();
        EdgePiece rest = piece;
        const auto part = [&](double t, std::uint32_t vertex) {
            EdgePiece first = rest;
            first.high = vertex;
            first.at_high = piece.at_low + (piece.at_high - piece.at_low) * static_cast<float>(t);
            rest.low = vertex;
            rest.at_low = first.at_high;
            add(first, out);
        };
        for (const auto& [t, vertex] : cuts_) part(t, vertex);
        add(rest, out);
    }

  private:
    /// Returns the mean length, so that edges cross about two cells each.
    static double cell_width(const World& world, std::span<const EdgePiece> pieces, double tolerance) {
        double sum = 0;
        for (const EdgePiece& piece : pieces) sum += length_of(world, piece);
        return std::max({sum / static_cast<double>(std::max<std::size_t>(1, pieces.size())), 4 * tolerance, 1e-30});
    }

    /// Finds the vertices inside a piece, from low to high.
    void find_cuts(const EdgePiece& piece) {
        cuts_.clear();
        const Point a = point(world_->positions[piece.low]), d = point(world_->positions[piece.high]) - a;
        const double squared = dot(d, d), length = std::sqrt(squared);
        if (!(length > 2 * tolerance_)) return;
        const auto test = [&](std::uint32_t vertex) {
            if (tests_left_ == 0) return false;
            --tests_left_;
            const Point p = point(world_->positions[vertex]) - a;
            const double t = dot(p, d) / squared;
            if (t * length <= tolerance_ || (1 - t) * length <= tolerance_) return true;
            const Point off = p - along({}, d, t);
            if (dot(off, off) <= tolerance_ * tolerance_) cuts_.emplace_back(t, vertex);
            return true;
        };
        const auto steps = static_cast<std::size_t>(std::min(std::ceil(length / width_), 65536.0));
        for (std::size_t i = 0; i < steps; ++i) {
            const auto at = [&](std::size_t k) {
                return along(a, d, static_cast<double>(k) / static_cast<double>(steps));
            };
            if (!grid_.visit_near(at(i), at(i + 1), tolerance_, test)) break;
        }
        std::sort(cuts_.begin(), cuts_.end());
        cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    }

    static void add(EdgePiece piece, std::vector<EdgePiece>& out) {
        if (piece.low == piece.high) return;
        if (piece.low > piece.high) {
            std::swap(piece.low, piece.high);
            std::swap(piece.at_low, piece.at_high);
        }
        out.push_back(piece);
    }

    const World* world_;
    double tolerance_, width_;
    VertexGrid grid_;
    std::size_t tests_left_, cuts_left_;
    std::vector<std::pair<double, std::uint32_t>> cuts_;
};

}  // namespace

EdgePiece whole_piece(const World& world, const std::vector<std::uint32_t>& welded, const WorldEdge& edge) {
    const bool starts_low = welded[world.triangles[edge.triangle][edge.side]] == edge.low;
    return {edge.low, edge.high, edge.triangle, edge.side, starts_low ? 0.0f : 1.0f, starts_low ? 1.0f : 0.0f};
}

std::vector<EdgePiece> split_edges(const World& world, std::span<const EdgePiece> pieces, float tolerance,
                                   StopFlag stop) {
    std::vector<EdgePiece> result;
    Splitter splitter(world, pieces, tolerance);
    for (const EdgePiece& piece : pieces) {
        stop.check();
        splitter.split(piece, result);
    }
    std::sort(result.begin(), result.end(), [](const EdgePiece& a, const EdgePiece& b) {
        return std::tie(a.low, a.high, a.triangle, a.side, a.at_low) <
               std::tie(b.low, b.high, b.triangle, b.side, b.at_low);
    });
    return result;
}

}  // namespace lobelia
