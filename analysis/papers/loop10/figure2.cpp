// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/figure2.h"

#include "pipeline/mesh/subdivision_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tessemu {

namespace {

using Words = std::vector<std::uint32_t>;

// As printed: column a, then b where the row has it, then c.
struct PrintedRow {
    char kind; // F, E, V
    std::uint32_t point;
    Words offset_valence, index;
};
std::vector<PrintedRow> const& printed()
{
    static std::vector<PrintedRow> const rows{
        {'F', 5, {0, 3}, {0, 1, 2}},
        {'F', 6, {3, 3}, {0, 2, 3}},
        {'F', 7, {6, 3}, {0, 3, 4}},
        {'F', 8, {9, 3}, {0, 4, 1}},
        {'F', 9, {12, 4}, {4, 3, 2, 1}},
        {'E', 10, {}, {0, 5, 2, 6}},
        {'E', 11, {}, {1, 5, 0, 8}},
        {'E', 12, {}, {2, 5, 1, 9}},
        {'E', 13, {}, {0, 6, 3, 7}},
        {'E', 14, {}, {3, 6, 2, 9}},
        {'E', 15, {}, {0, 7, 4, 8}},
        {'E', 16, {}, {4, 7, 3, 9}},
        {'E', 17, {}, {1, 8, 4, 9}},
        {'V', 18, {0, 4}, {4, 8, 1, 5, 2, 6, 3, 7}},
        {'V', 19, {8, 3}, {4, 9, 2, 5, 0, 8}},
        {'V', 20, {14, 3}, {3, 6, 0, 5, 1, 9}},
        {'V', 21, {20, 3}, {4, 7, 0, 6, 2, 9}},
        {'V', 22, {26, 3}, {1, 8, 0, 7, 3, 9}},
    };
    return rows;
}

Words part(Words const& table, std::size_t first, std::size_t count)
{
    auto const from = table.begin() + std::ptrdiff_t(std::min(first, table.size()));
    return {from, from + std::min(std::ptrdiff_t(count), table.end() - from)};
}

// Ours of a printed row.
PrintedRow our_row(SubdivisionTables const& t, char kind, std::size_t i)
{
    auto const n = std::uint32_t(i);
    if (kind == 'E') return {kind, t.first_edge_point() + n, {}, part(t.edge_index, 4 * i, 4)};
    bool const face = kind == 'F';
    Words const offset_valence =
        part(face ? t.face_offset_valence : t.vertex_offset_valence, 2 * i, 2);
    if (face)
        return {kind, t.first_face_point() + n, offset_valence,
                part(t.face_index, offset_valence.at(0), offset_valence.at(1))};
    return {kind, t.first_vertex_point() + n, offset_valence,
            part(t.vertex_index, offset_valence.at(0), 2 * offset_valence.at(1))};
}

// A vertex's row begins where the figure's does, if it has that pair.
void turn_like(PrintedRow const& paper, PrintedRow& ours)
{
    if (paper.kind != 'V') return;
    Words& row = ours.index;
    for (std::size_t k = 0; k < row.size(); k += 2)
        if (row[k] == paper.index[0]) {
            std::rotate(row.begin(), row.begin() + std::ptrdiff_t(k), row.end());
            return;
        }
}

std::string in_words(Words const& row)
{
    std::string out;
    for (std::uint32_t w : row) out += fmt::format("{:>3}", w);
    return out;
}

} // namespace

ControlMesh loop10_pyramid()
{
    ControlMesh m;
    m.name = "pyramid";
    m.positions = {{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (Words const& f : {Words{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {4, 3, 2, 1}})
        m.add_face(f);
    return m;
}

PaperTable reproduce_loop10_figure2()
{
    ControlMesh const mesh = loop10_pyramid();
    Topology const topology(mesh);
    SubdivisionTables const tables = catmull_clark_tables(topology, Sharpness(topology), 0, false);
    PaperTable out;
    out.title = "LOOP10 figure 2: the tables of subdivision of the pyramid";
    std::size_t equal = 0;
    std::string figure = "Ours, as the figure has them:\n\n        a   b        c\n";
    std::array<std::size_t, 128> next{}; // by kind
    for (PrintedRow const& paper : printed()) {
        PrintedRow ours = our_row(tables, paper.kind, next[std::size_t(paper.kind)]++);
        turn_like(paper, ours);
        figure += fmt::format("  {} {:>5}  {:<7} {}\n", paper.kind, ours.point,
                              in_words(ours.offset_valence), in_words(ours.index));
        std::string const row = fmt::format("{} {}", paper.kind, paper.point);
        auto const add = [&](std::string const& column, double printed, double made) {
            out.cells.push_back({row, column, printed, made});
            equal += printed == made;
        };
        add("a", paper.point, ours.point);
        auto const add_all = [&](char const* column, Words const& theirs, Words const& made) {
            for (std::size_t k = 0; k < std::max(theirs.size(), made.size()); ++k)
                add(fmt::format("{}, entry {}", column, k + 1),
                    k < theirs.size() ? double(theirs[k]) : -1,
                    k < made.size() ? double(made[k]) : -1);
        };
        add_all("b", paper.offset_valence, ours.offset_valence);
        add_all("c", paper.index, ours.index);
    }
    out.remarks = {
        figure, fmt::format("{} of {} numbers are equal.", equal, out.cells.size()),
        "Edges are numbered as they are met: faces in order, at corner k the edge to corner k - 1; "
        "so all rows come out in the printed order. With which edge a vertex's row begins is "
        "arbitrary in the figure: ours are turned to begin there, which changes no sum but in "
        "rounding."};
    return out;
}

} // namespace tessemu
