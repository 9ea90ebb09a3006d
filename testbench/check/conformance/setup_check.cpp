#include "testbench/check/conformance/setup_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "testbench/check/conformance/height_test_check.h"

namespace tessera {

using namespace setup_check;

namespace {

using datapath::Format;
using datapath::Registers;
using datapath::TableLayout;

std::string indexed(const char* name, std::size_t k) {
    return fmt::format("{}[{}]", name, k);
}

class RegisterCheck {
  public:
    RegisterCheck(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result)
        : registers_(setup.registers),
          formats_(setup.registers.formats),
          golden_(golden),
          job_(golden.job()),
          view_(golden::make_view(golden.scene().camera, golden.scene().placement)),
          judge_(result, "registers", "every register, rounded to its format") {}

    void run() {
        check_model_scale();
        check_formats();
        check_map();
        check_tests();
        check_displacement();
        check_transform();
        check_light();
        flag("triangulation", number(static_cast<int>(registers_.triangulation)),
             number(static_cast<int>(job_.hardware.triangulation)));
        flag("back_face_culling", number(registers_.back_face_culling), number(job_.hardware.culling == Culling::back));
    }

  private:
    void flag(const char* name, double hardware, double golden) { judge_.judge(name, hardware, golden, exact); }

    template <std::size_t Size, typename Integer>
    void row(const char* name, const std::array<Integer, Size>& hardware, const std::array<double, Size>& golden,
             const std::array<double, Size>& leeway) {
        for (std::size_t k = 0; k < Size; ++k)
            judge_.judge([&] { return indexed(name, k); }, number(hardware[k]), golden[k], to_nearest, leeway[k]);
    }
    void direction(const char* name, const std::array<std::int32_t, 3>& hardware, const glm::dvec3& golden,
                   double leeway) {
        const double lsb = lsb_per_unit(formats_.normal);
        row(name, hardware, {golden.x * lsb, golden.y * lsb, golden.z * lsb},
            {leeway * lsb, leeway * lsb, leeway * lsb});
    }

    void format(const char* name, const Format& hardware, const Format& golden) {
        judge_.judge([&] { return fmt::format("formats.{}.bits", name); }, hardware.bits, golden.bits, exact);
        judge_.judge([&] { return fmt::format("formats.{}.fraction", name); }, hardware.fraction, golden.fraction,
                     exact);
        judge_.judge([&] { return fmt::format("formats.{}.lowest", name); }, number(hardware.lowest),
                     number(golden.lowest), exact);
        judge_.judge([&] { return fmt::format("formats.{}.highest", name); }, number(hardware.highest),
                     number(golden.highest), exact);
    }

    void check_formats() {
        const Job::Formats& job = job_.formats;
        const auto bits = [](std::int64_t value) { return static_cast<int>(value); };
        format("position", formats_.position,
               Format::make_signed(bits(job.position_bits), bits(job.position_fraction)));
        format("normal", formats_.normal, Format::make_signed(bits(job.normal_bits), bits(job.normal_fraction)));
        format("texture", formats_.texture,
               Format::make_unsigned(bits(job.texture_integer + job.texture_fraction) + 1, bits(job.texture_fraction)));
        format("displacement", formats_.displacement,
               Format::make_unsigned(bits(job.displacement_bits), bits(job.displacement_bits)));
        format("screen", formats_.screen, Format::make_signed(bits(job.screen_bits), bits(job.screen_fraction)));
        flag("formats.generation_bits", formats_.generation_bits, number(job.generation_bits));
        flag("formats.highlight_tag", number(formats_.highlight_tag), number(job_.tests.highlight));
        flag("formats.distances", number(formats_.distances), number(golden_.map().height_test().uses_distances()));
        check_view_distance();
        check_summed_height();
    }

    /// w has a position's width and the most fraction bits, up to the position's, with which the farthest w fits.
    void check_view_distance() {
        const Format& hardware = formats_.view_distance;
        format("view_distance", hardware, Format::make_signed(formats_.position.bits, hardware.fraction));
        const double half_range = std::ldexp(1.0, formats_.position.bits - 1 - formats_.position.fraction);
        const glm::dvec4 size = glm::abs(view_.row_w);
        const double farthest = (size.x + size.y + size.z) * half_range + size.w;
        const auto fits = [&](int fraction, double margin) {
            return std::ldexp(farthest * margin, fraction) <= number(hardware.highest);
        };
        // The rows in the registers are rounded, so a distance at the limit may or may not fit.
        constexpr double about = 1e-5;
        judge_.require(hardware.fraction <= formats_.position.fraction && fits(hardware.fraction, 1 - about) &&
                           (hardware.fraction == formats_.position.fraction || !fits(hardware.fraction + 1, 1 + about)),
                       [&] {
                           return fmt::format(
                               "formats.view_distance.fraction = {} is not the largest with which the distance of the "
                               "farthest position, {:.6g} world units, fits {} bits",
                               hardware.fraction, farthest, hardware.bits);
                       });
    }

    void check_summed_height() {
        const Format& hardware = formats_.summed_height;
        format("summed_height", hardware, Format::make_unsigned(hardware.bits, 0));
        const double largest = largest_rectangle() * golden_.scene().highest_code;
        const auto holds = [&](int bits) { return largest < std::ldexp(1.0, bits); };
        const std::int64_t wanted = job_.formats.summed_height_bits;
        judge_.require(holds(hardware.bits) && hardware.bits == (wanted > 0  ? wanted
                                                                 : holds(32) ? 32
                                                                 : holds(40) ? 40
                                                                             : 48),
                       [&] {
                           return fmt::format(
                               "formats.summed_height.bits = {}, but the largest rectangle's sum is up to "
                               "{:.0f} and formats.summed_height_bits = {}",
                               hardware.bits, largest, wanted);
                       });
    }

    /// The largest area in texels, over base triangles, of a triangle's widest times its highest rectangle.
    double largest_rectangle() const {
        double largest = 0;
        for (std::uint32_t triangle = 0; triangle < golden_.mesh().triangles.size(); ++triangle) {
            golden::Rectangle both;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto texture = [&](std::size_t corner) {
                    return golden::on_grid(golden_.vertex(triangle, corner).texture,
                                           1 / lsb_per_unit(formats_.texture));
                };
                const golden::Rectangle size = golden_.map().rectangle_size(texture(k), texture((k + 1) % 3));
                both.width = std::max(both.width, size.width);
                both.height = std::max(both.height, size.height);
            }
            largest = std::max(largest, number(both.width) * number(both.height));
        }
        return largest;
    }

    void check_model_scale() {
        const golden::Scene& scene = golden_.scene();
        const double scale = scene.placement.scale;
        int exponent = 0;
        judge_.require(scale > 0 && std::isfinite(scale) && std::frexp(scale, &exponent) == 0.5,
                       [&] { return fmt::format("the model's scale, {:.17g}, is not a power of two", scale); });
        const double height = std::max(std::abs(scene.lowest), std::abs(scene.highest));
        double reach = 0;
        for (const BaseVertex& vertex : golden_.mesh().vertices) {
            const glm::dvec3 world = glm::abs(vertex.position - scene.placement.centre);
            reach = std::max({reach, world.x, world.y, world.z});
        }
        const double limit = number(formats_.position.highest) / lsb_per_unit(formats_.position);
        judge_.require((reach + height) * scale <= limit, [&] {
            return fmt::format("the displaced mesh reaches {:.6g} world units; a position holds up to {:.6g}",
                               (reach + height) * scale, limit);
        });
        // The largest scale that leaves half of the range free: S's register holds at most twice the range of heights.
        const Job::Formats& asked = job_.formats;
        const double quarter = std::ldexp(1.0, static_cast<int>(asked.position_bits - asked.position_fraction) - 3);
        const double used = (reach + 2 * height) * scale;
        judge_.require(used == 0 || used > quarter * (1 - 0x1p-20), [&] {
            return fmt::format("the displaced mesh reaches only {:.6g} world units of {:.6g}: its scale is too small",
                               (reach + height) * scale, limit);
        });
    }

    void check_map() {
        const golden::Map& map = golden_.map();
        const auto repeats = [](golden::AddressMode mode) { return number(mode == golden::AddressMode::repeat); };
        const auto repeats_here = [](datapath::AddressMode mode) {
            return number(mode == datapath::AddressMode::repeat);
        };
        flag("map.width", registers_.map.width, map.width());
        flag("map.height", registers_.map.height, map.height());
        flag("map.address_u", repeats_here(registers_.map.address_u), repeats(map.address_u()));
        flag("map.address_v", repeats_here(registers_.map.address_v), repeats(map.address_v()));
        judge_layout(judge_, "displacement_map", registers_.displacement_map, map.width(), map.height(),
                     formats_.displacement.bits);
        judge_layout(judge_, "normal_map", registers_.normal_map, map.width(), map.height(), 3 * formats_.normal.bits);
        check_of(job_.hardware.height_test).check_layout(registers_, golden_, judge_);
        std::array<const TableLayout*, 3> tables{&registers_.displacement_map, &registers_.normal_map,
                                                 &registers_.height_table};
        std::sort(tables.begin(), tables.end(),
                  [](const TableLayout* a, const TableLayout* b) { return a->base < b->base; });
        for (std::size_t k = 0; k < 2; ++k)
            judge_.require(tables[k]->base + tables[k]->bytes() <= tables[k + 1]->base, [&] {
                return fmt::format("the tables at {:#x} and {:#x} overlap", tables[k]->base, tables[k + 1]->base);
            });
    }

    void check_tests() {
        const datapath::TestParameters& tests = registers_.tests;
        const golden::Parameters& golden = golden_.parameters();
        const double normal = lsb_per_unit(formats_.normal);
        flag("tests.normal_test", number(tests.normal_test), number(golden.enabled.normal));
        flag("tests.summed_height_test", number(tests.summed_height_test), number(golden.enabled.summed_height));
        flag("tests.view_test", number(tests.view_test), number(golden.enabled.view));
        flag("tests.tex_coord_test", number(tests.tex_coord_test), number(golden.enabled.tex_coord));
        flag("tex_coord_fraction", std::ldexp(1.0, formats_.tex_coord_fraction), golden.texel_parts);
        flag("tests.generation_test", number(tests.generation_test), number(golden.enabled.generation));
        flag("tests.highlight_test", number(tests.highlight_test), number(golden.enabled.highlight));
        judge_.judge("tests.normal_threshold", tests.normal_threshold, golden.normal_threshold * normal, rounded_down);
        flag("tests.summed_height_unit", number(tests.summed_height_unit == SummedHeightUnit::area),
             number(job_.tests.summed_height_unit == SummedHeightUnit::area));
        check_of(job_.hardware.height_test).check_thresholds(registers_, golden_, judge_);
        const auto declared = functions_of(job_.hardware.height_test).thresholds(formats_);
        for (std::size_t k = 0; k < declared.size(); ++k)
            if (declared[k].bits == 0)
                judge_.judge([&] { return indexed("tests.height_thresholds", k); }, number(tests.height_thresholds[k]),
                             0, exact);
        judge_.judge("tests.view_threshold", tests.view_threshold,
                     golden.view_threshold * lsb_per_unit(formats_.screen), rounded_down);
        flag("tests.generation_limit", tests.generation_limit, golden.generation_limit);
        // Without the test its registers do not exist and read as 0.
        const double on = number(golden.enabled.highlight);
        direction("tests.half_vector", tests.half_vector, on * golden.half_vector, on * halfway_rounding());
        const double cosine = on * golden.highlight_cosine * normal * normal;
        judge_.judge("tests.highlight_cosine", number(tests.highlight_cosine), cosine, to_nearest,
                     double_rounding * normal * normal);
        judge_.judge("tests.highlight_normal_threshold", tests.highlight_normal_threshold,
                     on * golden.highlight_normal_threshold * normal, rounded_down);
    }

    /// Rounding error of the half vector's components: the axes' error over the length of the two directions' sum.
    double halfway_rounding() const {
        const double length = glm::length(golden::unit(golden_.scene().light) + view_.backward);
        return double_rounding / std::max(length, 1e-9);
    }

    void check_displacement() {
        // d = code / 2^bits: S compensates for the highest code, which is one step short of 1.
        const double position = lsb_per_unit(formats_.position);
        const double full = golden_.parameters().scale * (golden_.scene().highest_code + 1) * position;
        const double bias = golden_.parameters().bias * position;
        judge_.judge("displacement.scale", registers_.displacement.scale, full, to_nearest,
                     double_rounding * std::abs(full));
        judge_.judge("displacement.bias", registers_.displacement.bias, bias, to_nearest,
                     double_rounding * std::abs(bias));
    }

    void check_transform() {
        const datapath::TransformParameters& transform = registers_.transform;
        const double matrix = std::ldexp(1.0, datapath::TransformParameters::matrix_fraction);
        const double position = lsb_per_unit(formats_.position);
        const auto largest = [](const glm::dvec4& r) {
            return std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
        };
        const auto matrix_row = [&](const char* name, const std::array<std::int64_t, 4>& hardware,
                                    const glm::dvec4& golden) {
            const double size = largest(golden) * view_.rounding;
            const glm::dvec3 eye = glm::abs(view_.eye);
            row(name, hardware, {golden.x * matrix, golden.y * matrix, golden.z * matrix, golden.w * matrix * position},
                {size * matrix, size * matrix, size * matrix, size * (eye.x + eye.y + eye.z) * matrix * position});
        };
        const double shrink = std::ldexp(1.0, -transform.exponent);
        matrix_row("transform.row_x", transform.row_x, view_.row_x * shrink);
        matrix_row("transform.row_y", transform.row_y, view_.row_y * shrink);
        matrix_row("transform.row_w", transform.row_w, view_.row_w);
        const double reach = std::max(largest(view_.row_x), largest(view_.row_y)) * shrink;
        constexpr double about = 1e-9;
        judge_.require(
            transform.exponent >= 0 && reach <= 1 + about && (transform.exponent == 0 || reach > 0.5 - about), [&] {
                return fmt::format("transform.exponent = {}: the rows' largest value is {:.6g}, not in 1/2 .. 1",
                                   transform.exponent, reach);
            });
        // Values beyond every possible w are equivalent.
        judge_.judge("transform.near_plane", number(transform.near_plane),
                     std::min(view_.near_plane * matrix * position, 0x1p62), rounded_down);
        const std::array<double, 3> eye{view_.eye.x, view_.eye.y, view_.eye.z};
        for (std::size_t k = 0; formats_.distances && k < 3; ++k)
            judge_.judge([&] { return indexed("transform.eye", k); }, number(transform.eye[k]), eye[k] * position,
                         to_nearest, double_rounding * std::abs(eye[k]) * position);
        direction("transform.normal_rows[0]", transform.normal_rows[0], view_.right, view_.rounding);
        direction("transform.normal_rows[1]", transform.normal_rows[1], view_.up, view_.rounding);
        direction("transform.normal_rows[2]", transform.normal_rows[2], view_.backward, view_.rounding);
    }

    void check_light() {
        direction("light.direction", registers_.light.direction, golden::light_as_seen(golden_.scene()),
                  4 * view_.rounding);
        judge_.judge("light.ambient", registers_.light.ambient, job_.hardware.ambient * 256, to_nearest);
    }

    const Registers& registers_;
    const datapath::Formats& formats_;
    const GoldenJob& golden_;
    const Job& job_;
    golden::View view_;
    Judge judge_;
};

class BaseCheck {
  public:
    BaseCheck(const MachineSetup& setup, const GoldenJob& golden, SetupResult& result)
        : setup_(setup),
          formats_(setup.registers.formats),
          golden_(golden),
          result_(result),
          judge_(result, "base vertices", "every field of every base triangle's vertices, to nearest") {}

    void run() {
        std::size_t next = 0;
        for (std::uint32_t triangle = 0; triangle < golden_.mesh().triangles.size(); ++triangle) {
            Corners corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = {golden_.vertex(triangle, k), golden_.tangent_rounding(triangle, k)};
            if (may_collapse(corners) && (next == setup_.base_triangles.size() || !is(next, corners)))
                continue;
            if (next == setup_.base_triangles.size()) {
                judge_.require(false, [&] { return fmt::format("triangle {} of the mesh is missing", triangle); });
                return;
            }
            check(next, corners);
            result_.base_triangles.push_back(triangle);
            ++next;
        }
        judge_.require(next == setup_.base_triangles.size(), [&] {
            return fmt::format("{} base triangles, but the mesh has {}", setup_.base_triangles.size(), next);
        });
    }

  private:
    struct Corner {
        golden::Vertex vertex;
        double tangent_rounding;
    };
    using Corners = std::array<Corner, 3>;

    /// Whether rounding may have merged two corners in both formats: they are less than an LSB apart.
    bool may_collapse(const Corners& corners) const {
        const double position = lsb_per_unit(formats_.position), texture = lsb_per_unit(formats_.texture);
        for (std::size_t k = 0; k < 3; ++k) {
            const golden::Vertex &a = corners[k].vertex, &b = corners[(k + 1) % 3].vertex;
            if (glm::all(glm::lessThanEqual(glm::abs(a.position - b.position) * position, glm::dvec3(1))) &&
                glm::all(glm::lessThanEqual(glm::abs(a.texture - b.texture) * texture, glm::dvec2(1))))
                return true;
        }
        return false;
    }

    /// Whether base triangle `index` matches; used where the triangle may be absent.
    bool is(std::size_t index, const Corners& corners) const {
        SetupResult trial;
        BaseCheck check(setup_, golden_, trial);
        check.check(index, corners);
        return trial.passed();
    }

    void check(std::size_t index, const Corners& corners) {
        const datapath::Triangle& triangle = setup_.base_triangles[index];
        const auto of_triangle = [&](const char* field) {
            return [index, field] { return fmt::format("triangle {}, {}", index, field); };
        };
        judge_.judge(of_triangle("base"), triangle.base, number(index), exact);
        judge_.judge(of_triangle("split_by"), triangle.split_by, 0, exact);
        judge_.judge(of_triangle("stopped_by"), triangle.stopped_by, 0, exact);
        judge_.judge(of_triangle("finished"), number(triangle.finished), 0, exact);
        const glm::dvec2 periods = periods_added(triangle, corners);
        for (std::size_t k = 0; k < 3; ++k) {
            const datapath::Vertex& hardware = triangle.vertices[k];
            const golden::Vertex& golden = corners[k].vertex;
            const auto name = [&](const char* field) {
                return [index, k, field] { return fmt::format("triangle {}, vertex {}, {}", index, k, field); };
            };
            const double position = lsb_per_unit(formats_.position);
            const auto nearest = [&](const char* field, double value, double expected, double leeway = 0) {
                judge_.judge(name(field), value, expected, to_nearest, double_rounding * std::abs(expected) + leeway);
            };
            nearest("position.x", hardware.position.x, golden.position.x * position);
            nearest("position.y", hardware.position.y, golden.position.y * position);
            nearest("position.z", hardware.position.z, golden.position.z * position);
            const double normal = lsb_per_unit(formats_.normal);
            nearest("normal.x", hardware.normal.x, golden.normal.x * normal);
            nearest("normal.y", hardware.normal.y, golden.normal.y * normal);
            nearest("normal.z", hardware.normal.z, golden.normal.z * normal);
            const double rounding = corners[k].tangent_rounding * normal;
            nearest("tangent.x", hardware.tangent.x, golden.tangent.x * normal, rounding);
            nearest("tangent.y", hardware.tangent.y, golden.tangent.y * normal, rounding);
            nearest("tangent.z", hardware.tangent.z, golden.tangent.z * normal, rounding);
            judge_.judge(name("handedness"), hardware.handedness, golden.handedness, exact);
            judge_.judge(name("generation"), hardware.generation, 0, exact);
            judge_.judge(name("displaced_known"), number(hardware.displaced_known), 0, exact);
            judge_.judge(name("screen_normal_known"), number(hardware.screen_normal_known), 0, exact);
            const golden::Map& map = golden_.map();
            check_texture(name("texture.u"), hardware.texture.u, golden.texture.x, map.width(), periods.x);
            check_texture(name("texture.v"), hardware.texture.v, golden.texture.y, map.height(), periods.y);
        }
    }

    /// The whole periods by which the host moved a triangle on repeated axes. Taken from the mean of the corners: where a
    /// period is one LSB, rounding may move a single corner by a period.
    glm::dvec2 periods_added(const datapath::Triangle& triangle, const Corners& corners) const {
        const golden::Map& map = golden_.map();
        glm::dvec2 moved(0);  // texels
        for (std::size_t k = 0; k < 3; ++k) {
            const datapath::TexCoord& t = triangle.vertices[k].texture;
            moved += (glm::dvec2(t.u, t.v) / lsb_per_unit(formats_.texture) - corners[k].vertex.texture) / 3.0;
        }
        const auto whole = [](double texels, int size, golden::AddressMode mode) {
            return mode == golden::AddressMode::repeat ? std::round(texels / size) : 0;
        };
        return {whole(moved.x, map.width(), map.address_u()), whole(moved.y, map.height(), map.address_v())};
    }

    template <typename Name>
    void check_texture(Name name, std::uint32_t hardware, double golden, int size, double periods) {
        const double lsb = lsb_per_unit(formats_.texture);
        judge_.judge(name, hardware, (golden + periods * size) * lsb, to_nearest,
                     double_rounding * (std::abs(golden) + std::abs(periods) * size) * lsb);
    }

    const MachineSetup& setup_;
    const datapath::Formats& formats_;
    const GoldenJob& golden_;
    SetupResult& result_;
    Judge judge_;
};

}  // namespace

std::uint64_t SetupResult::compared() const {
    std::uint64_t sum = 0;
    for (const Part& part : parts)
        sum += part.compared;
    return sum;
}

bool SetupResult::empty() const {
    return parts.empty() ||
           std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.compared == 0; });
}

std::uint64_t SetupResult::wrong() const {
    std::uint64_t sum = 0;
    for (const Part& part : parts)
        sum += part.wrong;
    return sum;
}

std::vector<std::uint32_t> received_triangles(const MachineSetup& setup, const GoldenJob& golden) {
    SetupResult result;
    BaseCheck(setup, golden, result).run();
    return result.base_triangles;
}

SetupResult check_setup(const MachineSetup& setup, const GoldenJob& golden, Simulation& simulation) {
    SetupResult result;
    RegisterCheck(setup, golden, result).run();
    BaseCheck(setup, golden, result).run();
    const auto check_height_table = check_of(golden.job().hardware.height_test).table_check(setup, golden, result);
    for (const auto& hosted : simulation.machines) {
        check_maps(setup, golden, hosted->host, result);
        check_height_table(hosted->host);
    }
    return result;
}

}  // namespace tessera
