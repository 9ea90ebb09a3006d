#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "modules/datapath/displace.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/registers.h"

namespace tessera::testing {

/// Bits of a stream, the lowest first.
class Wires {
  public:
    explicit Wires(std::vector<bool> bits = {}) : bits_(std::move(bits)) {}

    std::size_t size() const { return bits_.size(); }
    bool operator[](std::size_t k) const { return bits_[k]; }

    std::uint64_t slice(std::size_t lowest, int width) const {
        std::uint64_t value = 0;
        for (int k = 0; k < width; ++k)
            value |= std::uint64_t{bits_[lowest + static_cast<std::size_t>(k)]} << k;
        return value;
    }
    /// Two's complement.
    std::int32_t signed_slice(std::size_t lowest, int width) const {
        const auto sign = std::int64_t{1} << (width - 1);
        return static_cast<std::int32_t>((static_cast<std::int64_t>(slice(lowest, width)) ^ sign) - sign);
    }
    void append(std::int64_t value, int width) {
        for (int k = 0; k < width; ++k)
            bits_.push_back((value >> k & 1) != 0);
    }

  private:
    std::vector<bool> bits_;
};

/// Displace Vertex as a model in another language: wires in, wires out, an address and a code, one call per clock edge.
/// It uses the tables of modules/sockets/README.md and the registers, but no items, streams or SystemC. The arithmetic
/// is the datapath's.
class RtlDisplaceVertex {
  public:
    /// latency: cycles from the map's response to the result; stages: number of items it holds.
    RtlDisplaceVertex(const datapath::Registers& registers, int tag_bits, unsigned latency, std::size_t stages)
        : registers_(registers), tag_bits_(tag_bits), latency_(latency), stages_(stages) {}

    // Combinational.

    /// The address of the code that an item needs, if any.
    std::optional<std::uint64_t> address(const Wires& in) const {
        if (is_normal(in))
            return std::nullopt;
        const datapath::Formats& f = registers_.formats;
        const std::size_t t = p_at() + vector_bits(f.position) + vector_bits(f.normal);
        const datapath::TexCoord texel{static_cast<std::uint32_t>(in.slice(t, f.texture.bits)),
                                       static_cast<std::uint32_t>(in.slice(t + bits_of(f.texture), f.texture.bits))};
        return texel_address(texel, registers_.displacement_map, registers_.map, f);
    }
    /// The item's wires, followed by P'.
    Wires result(const Wires& in, std::uint64_t code) {
        const datapath::Formats& f = registers_.formats;
        datapath::Position displaced{};
        if (!is_normal(in)) {
            const auto [px, py, pz] = vector(in, p_at(), f.position.bits);
            const auto [nx, ny, nz] = vector(in, p_at() + vector_bits(f.position), f.normal.bits);
            datapath::Direction n{nx, ny, nz};
            if (is_edge(in))
                n = normalise(n, f, saturations);
            displaced =
                displace({px, py, pz}, n, static_cast<std::uint32_t>(code), registers_.displacement, f, saturations);
        }
        Wires out = in;
        for (const std::int32_t component : {displaced.x, displaced.y, displaced.z})
            out.append(component, f.position.bits);
        return out;
    }

    // CycleProcess.

    void clock_edge() {
        taken_ = false;
        for (Place& place : places_)
            if (place.answered && place.cycles_left > 0)
                --place.cycles_left;
    }
    bool ready() const { return !taken_ && places_.size() < stages_; }
    /// Takes an item; returns the address that it reads.
    std::optional<std::uint64_t> put(Wires in) {
        taken_ = true;
        const std::optional<std::uint64_t> asked = address(in);
        if (asked)
            places_.push_back({std::move(in), false, 0});
        else
            places_.push_back({result(in, 0), true, latency_});
        return asked;
    }
    /// The code of the first item that lacks one.
    void answer(std::uint64_t code) {
        for (Place& place : places_) {
            if (place.answered)
                continue;
            place = {result(place.wires, code), true, latency_};
            return;
        }
    }
    bool valid() const { return !places_.empty() && places_.front().answered && places_.front().cycles_left == 0; }
    const Wires& out() const { return places_.front().wires; }
    void take() { places_.pop_front(); }

    std::size_t items() const { return places_.size(); }
    bool first_lacks_its_code() const { return !places_.empty() && !places_.front().answered; }
    /// Whether the next clock edge changes the state.
    bool counts() const {
        for (const Place& place : places_)
            if (place.answered && place.cycles_left > 0)
                return true;
        return taken_;
    }

    datapath::Saturations saturations;

  private:
    struct Place {
        Wires wires;  // those of the item; once its code has arrived, those of the result
        bool answered;
        unsigned cycles_left;
    };
    struct Vector {
        std::int32_t x, y, z;
    };

    static constexpr int part_width = 4;
    template <class Format>
    static std::size_t bits_of(const Format& format) {
        return static_cast<std::size_t>(format.bits);
    }
    template <class Format>
    static std::size_t vector_bits(const Format& format) {
        return 3 * bits_of(format);
    }
    std::size_t part_at() const { return static_cast<std::size_t>(tag_bits_); }
    std::size_t p_at() const { return part_at() + part_width; }
    // parts: vertices 0 to 2, normals 3 to 5, edges 6 to 8
    bool is_normal(const Wires& in) const {
        const std::uint64_t part = in.slice(part_at(), part_width);
        return part >= 3 && part < 6;
    }
    bool is_edge(const Wires& in) const { return in.slice(part_at(), part_width) >= 6; }
    static Vector vector(const Wires& in, std::size_t lowest, int width) {
        const auto step = static_cast<std::size_t>(width);
        return {in.signed_slice(lowest, width), in.signed_slice(lowest + step, width),
                in.signed_slice(lowest + 2 * step, width)};
    }

    const datapath::Registers& registers_;
    int tag_bits_;
    unsigned latency_;
    std::size_t stages_;
    std::deque<Place> places_;
    bool taken_ = false;  // whether an item was taken in this cycle
};

}  // namespace tessera::testing
