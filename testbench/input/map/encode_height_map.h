#pragma once
#include <string>
#include <vector>

namespace tessera {

enum class MapFormat { pgm, png, exr };

/// A map file, and how a job turns its values back into heights: height = bias + scale * value.
struct EncodedMap {
    std::string bytes;
    double scale = 1, bias = 0;  ///< model units: displacement.scale and displacement.bias
    double step = 0;             ///< model units from one sample's value to the next; 0: not quantised
};

/// Heights as a map file that read_height_map.h reads: texel (x, y) is heights[y * width + x], y = 0 the
/// bottom row, model units, finite. The same heights give the same bytes.
///
/// pgm, png: 16 bit; the lowest height is sample 0, the highest 65535, every other the nearest in between, so at most
/// half a step off. Where all are the same, scale is 1 and every sample 0. exr: one channel Y of 32-bit floats, without
/// loss (ZIP); heights are rounded to float, 24 significant bits; scale 1, bias 0.
EncodedMap encode_height_map(int width, int height, const std::vector<double>& heights, MapFormat format);

}  // namespace tessera
