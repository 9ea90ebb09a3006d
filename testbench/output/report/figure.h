#pragma once
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace tessera {

/// One figure of a run.
struct Figure {
    std::string group;  ///< the unit, memory or stream it belongs to
    std::string name;
    std::variant<std::uint64_t, std::int64_t, double, std::string> value;
    std::string unit;
    std::string description;
};

/// Appends the figures of one group.
class FigureGroup {
  public:
    FigureGroup(std::vector<Figure>& all, std::string group) : all_(all), group_(std::move(group)) {}

    template <class Value>
    void add(std::string name, const Value& value, const char* unit, std::string description) {
        Figure figure{group_, std::move(name), {}, unit, std::move(description)};
        if constexpr (std::is_floating_point_v<Value>)
            figure.value = static_cast<double>(value);
        else if constexpr (std::is_signed_v<Value>)
            figure.value = static_cast<std::int64_t>(value);
        else if constexpr (std::is_arithmetic_v<Value>)
            figure.value = static_cast<std::uint64_t>(value);
        else
            figure.value = std::string(value);
        all_.push_back(std::move(figure));
    }

  private:
    std::vector<Figure>& all_;
    std::string group_;
};

}  // namespace tessera
