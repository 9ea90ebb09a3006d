#pragma once
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>

namespace tessera {

/// Finds the boxes near a point. Embree's single precision only excludes boxes: boxes are rounded outwards and radii
/// upwards, so that no box within the radius is missed; the caller calculates distances in double precision. Built on
/// one thread; queries are thread-safe. Coordinates should be about 1 in size and centred on 0: far from 0 more boxes
/// than necessary are visited.
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
        /// From p to the nearest point of the box, squared; 0 inside.
        double squared_distance(const glm::dvec3& p) const {
            const glm::dvec3 away = glm::max(glm::max(low - p, p - high), glm::dvec3(0));
            return glm::dot(away, away);
        }
    };

    /// Boxes may be empty, and `count` may be 0. Throws ResourceError when memory runs out.
    BoxHierarchy(std::size_t count, const std::function<Box(std::size_t)>& box);
    ~BoxHierarchy();

    /// Calls visit(index) for every box within `radius` of p, and for some farther away, in unspecified order. visit
    /// returns the radius for the rest of the search: the same or a smaller one.
    template <class Visit>
    void visit_near(const glm::dvec3& p, double radius, Visit&& visit) const {
        query(
            p, radius,
            [](void* context, std::size_t index) {
                return (*static_cast<std::remove_reference_t<Visit>*>(context))(index);
            },
            &visit);
    }

  private:
    using Callback = double (*)(void*, std::size_t);
    void query(const glm::dvec3& p, double radius, Callback visit, void* context) const;

    struct Handles;
    std::unique_ptr<Handles> handles_;
};

}  // namespace tessera
