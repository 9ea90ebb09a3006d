#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace tessera {

/// Finds the boxes near a point: a tree of boxes in Morton order, four per node. Its single precision only excludes
/// boxes: they are rounded outwards and radii upwards, so that no box within the radius is missed; the caller
/// calculates distances in double precision. Queries are thread-safe. Coordinates should be about 1 in size and centred
/// on 0: far from 0 more boxes than necessary are visited. Memory: about 40 bytes per box.
class BoxHierarchy {
  public:
    struct Box {
        glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

        void add(const glm::dvec3& p) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        void add(const Box& other) {
            low = glm::min(low, other.low);
            high = glm::max(high, other.high);
        }
        /// Of points, or of boxes.
        template <class Items>
        static Box about(const Items& items) {
            Box box;
            for (const auto& item : items)
                box.add(item);
            return box;
        }
        bool is_empty() const { return !(low.x <= high.x); }
        /// From p to the nearest point of the box, squared; 0 inside.
        double squared_distance(const glm::dvec3& p) const {
            const glm::dvec3 away = glm::max(glm::max(low - p, p - high), glm::dvec3(0));
            return glm::dot(away, away);
        }
    };

    /// Boxes may be empty, and `count` may be 0; `box` is called twice for each. all: about all boxes; it affects only
    /// speed, the tighter the faster. Throws ResourceError beyond 2^32 boxes.
    BoxHierarchy(std::size_t count, const Box& all, const std::function<Box(std::size_t)>& box);

    /// Calls visit(index) for every box within `radius` of p, and for some farther away, nearer ones roughly first.
    /// visit returns the radius for the rest of the search: the same or a smaller one.
    template <class Visit>
    void visit_near(const glm::dvec3& p, double radius, Visit&& visit) const {
        const glm::vec3 at(p);
        const double rounding = glm::length(p - glm::dvec3(at));
        float limit = squared_limit(radius + rounding);
        std::array<Waiting, most_waiting> stack;
        std::size_t waiting = 0;
        if (!levels_.empty())
            stack[waiting++] = {static_cast<std::uint32_t>(levels_.size()), 0, 0};
        while (waiting > 0) {
            const Waiting next = stack[--waiting];
            if (next.squared > limit)
                continue;
            if (next.level == 0) {
                const double smaller = visit(std::size_t{order_[next.index]});
                if (smaller < radius) {
                    radius = smaller;
                    limit = squared_limit(radius + rounding);
                }
                continue;
            }
            const Lanes squared = levels_[next.level - 1][next.index].squared_distances(at);
            const std::size_t first = waiting;
            for (std::uint32_t lane = 0; lane < lanes; ++lane) {
                if (squared[lane] > limit)
                    continue;
                std::size_t place = waiting++;
                for (; place > first && stack[place - 1].squared < squared[lane]; --place)
                    stack[place] = stack[place - 1];
                stack[place] = {next.level - 1, lanes * next.index + lane, squared[lane]};
            }
        }
    }

  private:
    static constexpr std::uint32_t lanes = 4;
    static constexpr std::size_t most_waiting = 64;  // 16 levels of 2^32 boxes, three left on each

    struct Waiting {
        std::uint32_t level, index;  // level 0: a box
        float squared;               // distance
    };
    /// One float of each child; GCC and clang calculate with all of them at once.
    using Lanes = float __attribute__((vector_size(lanes * sizeof(float))));

    /// The bounds of four children; unused ones are infinitely far.
    struct Node {
        Lanes low[3], high[3];  // by axis

        Node();
        void set(std::uint32_t lane, const Box& box);
        Box box() const;
        Lanes squared_distances(const glm::vec3& p) const {
            Lanes sum{};
            for (int axis = 0; axis < 3; ++axis) {
                const Lanes below = low[axis] - p[axis], above = p[axis] - high[axis];
                const Lanes outside = below > above ? below : above;
                const Lanes away = outside > 0 ? outside : Lanes{};
                sum += away * away;
            }
            return sum;
        }
    };

    /// Covers the rounding of squared_distances(); finite, so that unused children stay beyond it.
    static float squared_limit(double radius);

    std::vector<std::uint32_t> order_;       // the boxes that are not empty
    std::vector<std::vector<Node>> levels_;  // from the boxes' parents to the root
};

}  // namespace tessera
