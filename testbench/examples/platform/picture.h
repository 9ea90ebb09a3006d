#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "modules/device/driver/tessera_driver.h"

/// A grey picture of finished triangles, with a depth buffer.
class Picture {
  public:
    Picture(int width, int height)
        : width_(width),
          height_(height),
          grey_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 32),
          nearest_(grey_.size(), std::numeric_limits<double>::max()) {}

    /// screen_fraction: fraction bits of the screen format.
    void draw(const tessera_finished_triangle& triangle, int screen_fraction) {
        std::array<double, 3> x, y;
        for (std::size_t k = 0; k < 3; ++k) {
            if ((triangle.vertices[k].light & 256u) == 0)
                return;  // not in front of the near plane
            x[k] = std::ldexp(triangle.vertices[k].x, -screen_fraction);
            y[k] = std::ldexp(triangle.vertices[k].y, -screen_fraction);
        }
        const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        const auto [left, right] = std::minmax_element(x.begin(), x.end());
        const auto [bottom, top] = std::minmax_element(y.begin(), y.end());
        for (int row = std::max(0, static_cast<int>(*bottom)); area != 0 && row < std::min(height_ - 0.0, *top);
             ++row) {
            for (int column = std::max(0, static_cast<int>(*left)); column < std::min(width_ - 0.0, *right); ++column) {
                const auto part = [&](std::size_t a, std::size_t b) {
                    return ((x[b] - x[a]) * (row + 0.5 - y[a]) - (column + 0.5 - x[a]) * (y[b] - y[a])) / area;
                };
                const std::array<double, 3> weight{part(1, 2), part(2, 0), part(0, 1)};
                if (*std::min_element(weight.begin(), weight.end()) >= 0)
                    shade(column, row, weight, triangle);
            }
        }
    }

    /// Writes a PGM file. Returns false on failure.
    bool write(const std::string& name) const {
        std::FILE* const file = std::fopen(name.c_str(), "wb");
        if (file == nullptr)
            return false;
        std::fprintf(file, "P5 %d %d 255\n", width_, height_);
        const bool written = std::fwrite(grey_.data(), 1, grey_.size(), file) == grey_.size();
        return std::fclose(file) == 0 && written;
    }

  private:
    void shade(int column, int row, const std::array<double, 3>& weight, const tessera_finished_triangle& triangle) {
        double depth = 0, light = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            depth += weight[k] * triangle.vertices[k].w;
            light += weight[k] * (triangle.vertices[k].light & 255u);
        }
        const auto place = static_cast<std::size_t>(height_ - 1 - row) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(column);
        if (depth < nearest_[place]) {
            nearest_[place] = depth;
            grey_[place] = static_cast<unsigned char>(light + 0.5);
        }
    }

    int width_, height_;
    std::vector<unsigned char> grey_;
    std::vector<double> nearest_;
};
