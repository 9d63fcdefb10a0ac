// Tags of an OBJ file, `t NAME ints/floats/strings VALUE ...`, as OpenSubdiv's shapes have them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/obj_notes.h"
#include "pipeline/mesh/mesh.h"

#include <optional>
#include <string_view>

namespace tessemu {

/// Creases, corners, holes, and the rules of boundary, creases and triangles. What is wrong or not honoured is noted, and
/// skipped.
class ObjTags {
public:
    /// \param mesh  gets the tags; both outlive this
    ObjTags(ControlMesh& mesh, Notes& notes) : mesh_(mesh), notes_(notes) {}

    /// \param words  of the statement, "t" first; the text outlives this
    void read(std::vector<std::string_view> const& words, int line);
    /// When all faces are read. The last tag about an edge or a vertex holds.
    /// \param vertices  of the file
    void apply(std::size_t vertices);

private:
    struct Tag {
        int line;
        std::string name;
        std::vector<std::int64_t> ints;
        std::vector<float> floats;
        std::vector<std::string_view> strings;
    };
    using Edge = std::pair<std::uint32_t, std::uint32_t>;

    void apply(Tag const& t, std::size_t vertices);
    // \param kind  of tags; like ones are counted
    void note_tag(int line, std::string const& kind, std::string const& text);
    bool in_range(Tag const& t, std::int64_t value, std::size_t limit, char const* what);
    float sharpness(Tag const& t, std::size_t item, std::size_t ints) const;
    bool has_sharpness(Tag const& t, std::size_t ints);
    // Whether the tag's only word is the second; none, and a note, if it is neither.
    std::optional<bool> one_of(Tag const& t, std::string_view first, std::string_view second);
    bool is_edge(std::uint32_t a, std::uint32_t b);

    ControlMesh& mesh_;
    Notes& notes_;
    std::vector<Tag> tags_;
    std::vector<Edge> edges_; ///< of the faces, ascending; made for the first crease
    std::map<Edge, ControlMesh::Crease> creases_;
    std::map<std::uint32_t, float> corners_;
};

} // namespace tessemu
