#pragma once
#include <string>
#include <vector>

namespace tessera {

enum class MapFormat { pgm, png, exr };

/// A map file, and the conversion of its values to heights in a job: height = bias + scale * value.
struct EncodedMap {
    std::string bytes;
    double scale = 1, bias = 0;  ///< model units: displacement.scale and displacement.bias
    double step = 0;             ///< quantisation step in model units; 0: not quantised
};

/// Encodes heights as a map file for read_height_map.h: texel (x, y) is heights[y * width + x], y = 0 the bottom row,
/// model units, finite. The same heights give the same bytes.
///
/// pgm, png: 16 bit; the lowest height is sample 0, the highest 65535, others are rounded to the nearest sample, with
/// an error of at most half a step. If all are equal, scale is 1 and every sample 0. exr: one channel Y of 32-bit
/// floats, lossless (ZIP); heights are rounded to float, 24 significant bits; scale 1, bias 0.
EncodedMap encode_height_map(int width, int height, const std::vector<double>& heights, MapFormat format);

}  // namespace tessera
