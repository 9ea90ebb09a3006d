#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/datapath/pack_triangle.h"
#include "modules/sockets/items.h"

namespace tessera {

/// An item as the bits on its stream's wires, lowest first, and its annotations, which have no wires. A unit written in
/// another language exchanges items in this form.
struct PackedItem {
    static constexpr std::size_t most_bytes = 448;
    static constexpr std::size_t most_annotations = 4;  // of a triangle with its origin

    std::array<unsigned char, most_bytes> bytes{};
    std::array<std::uint32_t, most_annotations> annotations{};
};

namespace packed {

class Writer : public datapath::FieldWriter {
  public:
    explicit Writer(PackedItem& packed) : FieldWriter(packed.bytes.data()), packed_(packed) {}
    std::uint32_t annotation(const char*, std::uint32_t value) {
        return packed_.annotations.at(annotations_++) = value;
    }

  private:
    PackedItem& packed_;
    std::size_t annotations_ = 0;
};

class Reader : public datapath::FieldReader {
  public:
    explicit Reader(const PackedItem& packed) : FieldReader(packed.bytes.data()), packed_(packed) {}
    std::uint32_t annotation(const char*, std::uint32_t) { return packed_.annotations.at(annotations_++); }

  private:
    const PackedItem& packed_;
    std::size_t annotations_ = 0;
};

}  // namespace packed

/// Returns false if a value does not fit its field; its highest bits are then lost.
template <class Item>
[[nodiscard]] bool pack_item(const Item& item, const datapath::Formats& formats, int tag_bits, PackedItem& packed) {
    packed::Writer writer(packed);
    describe_item(writer, item, formats, tag_bits);
    writer.finish();
    return writer.fits();
}

template <class Item>
Item unpack_item(const PackedItem& packed, const datapath::Formats& formats, int tag_bits) {
    Item item;
    packed::Reader reader(packed);
    describe_item(reader, item, formats, tag_bits);
    return item;
}

}  // namespace tessera
