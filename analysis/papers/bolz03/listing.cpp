// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/bolz03/listing.h"

#include "shaders_cpp/bolz/table_pixel_shaders.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

using Op = ExpressionGraph::Op;

// What the shaders of one recording read.
class Tables {
public:
    Tables(ExpressionGraph& graph, int points) : graph_(graph), points_(points) {}

    OrderedSums ordered()
    {
        int const pairs = (points_ + 1) / 2;
        return {buffer(0), buffer(1), 2 * pairs};
    }
    PackedSums packed() { return {buffer(0), TableLayout::of((points_ + 3) / 4), points_}; }
    Texture2D texture(int slot) const
    {
        return {std::span<std::byte const>(), Format::R32_FLOAT, 1, 1, 1, slot, "tables", &graph_};
    }

private:
    // Told apart by their address.
    ConstantBuffer<float> buffer(std::size_t i)
    {
        return ConstantBuffer<float>(std::span(memory_).subspan(i, 1), &graph_);
    }

    ExpressionGraph& graph_;
    int points_;
    std::array<float, 2> memory_{};
};

TableListing record(ExpressionGraph& graph, auto const& shader)
{
    TableCoordinate<Graph> in;
    in.at.x = Graph::input(graph);
    in.at.y = Graph::input(graph);
    float4<Graph> const out = shader.template operator()<Graph>(PixelInput<Graph>{}, in);
    // w is a constant, which a program of then leaves to the target's default.
    std::vector<Graph> results{out.x, out.y, out.z};
    std::uint64_t rounded = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        ExpressionGraph::Node const n = graph.nodes()[std::size_t(results[k].id)];
        if (n.op != Op::Sub) continue;
        // Of rounded_cross: results too, so that none becomes part of a MAD.
        results.emplace_back(graph, n.a);
        results.emplace_back(graph, n.b);
        ++rounded;
    }
    TableListing l;
    l.written = graph.written();
    l.fused = graph.fused();
    l.fused.mad -= rounded, l.fused.mul += rounded, l.fused.add += rounded;
    l.loads = graph.loads();
    l.code = vector_code(graph, results);
    return l;
}

std::string operations(FlopCount const& f)
{
    return fmt::format("{} ({} add, {} mul, {} mad)", f.add + f.mul + f.mad, f.add, f.mul, f.mad);
}

std::string lines(VectorCode const& code, std::size_t first, std::size_t count)
{
    std::string out;
    for (std::size_t i = first; i < std::min(code.listing.size(), first + count); ++i)
        out += "\n    " + code.listing[i];
    return out;
}

} // namespace

TableListing position_listing(TableOrder order, int points)
{
    ExpressionGraph graph;
    Tables t(graph, points);
    if (order == TableOrder::Global)
        return record(graph, TablePositionPixelShader<OrderedSums>{t.ordered(), t.texture(0)});
    return record(graph, TablePositionPixelShader<PackedSums>{t.packed(), t.texture(0)});
}

TableListing normal_listing(TableOrder order, int points)
{
    ExpressionGraph graph;
    Tables t(graph, points);
    if (order == TableOrder::Global)
        return record(graph,
                      TableNormalPixelShader<OrderedSums>{t.ordered(), t.texture(0), t.texture(1)});
    return record(graph,
                  TableNormalPixelShader<PackedSums>{t.packed(), t.texture(0), t.texture(1)});
}

PaperTable reproduce_bolz03_listing()
{
    PaperTable out;
    out.title = "BOLZ03 3.1: instructions of a fragment, the scheme's own pixel shaders recorded";
    struct Printed {
        char const* name;
        TableOrder order;
        int valence, instructions, normals; ///< 0: not printed
    };
    constexpr Printed kPrinted[] = {{"bit-exact", TableOrder::Global, 4, 40, 0},
                                    {"bit-exact", TableOrder::Global, 9, 65, 0},
                                    {"packed", TableOrder::Table, 4, 24, 52},
                                    {"packed", TableOrder::Table, 9, 40, 84}};
    std::string scalar = "Scalar operations of a fragment, which the paper does not count: as "
                         "written; unique and fused; texels";
    std::string unprinted = "Normals in the bit-exact order, which the paper does not print:";
    for (Printed const& p : kPrinted) {
        int const points = control_points_at(p.valence);
        std::string const row =
            fmt::format("{}, valence {} ({} tables)", p.name, p.valence, points);
        TableListing const position = position_listing(p.order, points),
                           normal = normal_listing(p.order, points);
        auto const count = [](VectorCode const& c) { return double(c.instructions()); };
        out.cells.push_back({row, "instructions", double(p.instructions), count(position.code)});
        out.cells.push_back({row, "registers", 2, double(position.code.registers)});
        if (p.normals)
            out.cells.push_back(
                {row, "additional instructions of normals", double(p.normals), count(normal.code)});
        else
            unprinted += fmt::format("\n  valence {}: {} in {} registers", p.valence,
                                     normal.code.instructions(), normal.code.registers);
        for (auto const& [what, l] : {std::pair{"position", &position}, {"normal", &normal}})
            scalar += fmt::format("\n  {}, {}: {}; {}; {}", row, what, operations(l->written),
                                  operations(l->fused), l->loads);
    }
    VectorCode const exact = position_listing(TableOrder::Global, 16).code,
                     packed = position_listing(TableOrder::Table, 16).code,
                     normal = normal_listing(TableOrder::Table, 16).code;
    out.remarks = {
        "Two control points in the bit-exact order, where the paper prints\n"
        "    R1.xyzw = OffSet01.xyzw + TEXCOORD0.xyxy;\n"
        "    R1.x = TEX0[R1.xy]; R0 += R1.x * cp0\n"
        "    R1.x = TEX0[R1.zw]; R0 += R1.x * cp1\n"
        "ours:" +
            lines(exact, 5, 5),
        "Four in the order of the tables, where the paper prints\n"
        "    R0 = 33*i + TEXCOORD0; R1 = TEX0[R0];\n"
        "    R0 += R1.x * cp0; R0 += R1.y * cp1;\n"
        "    R0 += R1.z * cp2; R0 += R1.w * cp3;\n"
        "(whose R0 is both address and sum, a slip: there are two registers) ours:" +
            lines(packed, 6, 6),
        "The paper prints no listing of normals. Two packed sums are 48 and 80 instructions, a "
        "cross "
        "product MUL and MAD: 50 and 82; what the other two do it does not say. Ours take both "
        "tangents' weights at one address, which saves 4 and 7, and 3 for the cross product, each "
        "of "
        "whose products is rounded by itself: with a MAD two patches' normals differ on their "
        "shared "
        "edge. The end of ours, valence 4:" +
            lines(normal, normal.listing.size() - 3, 3),
        unprinted + ".", scalar + "."};
    return out;
}

} // namespace tessemu
