// SPDX-License-Identifier: Apache-2.0
#include "analysis/mistakes.h"

#include "pipeline/forms/stencil_form.h"
#include "pipeline/forms/two_stage_form.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace tessemu {

std::string_view name_of(Mistake mistake)
{
    switch (mistake) {
    case Mistake::Order:
        return "order";
    case Mistake::Contraction:
        return "contraction";
    case Mistake::Factors:
        return "factors";
    case Mistake::Normals:
        return "normals";
    case Mistake::Fold:
        return "fold";
    case Mistake::Weights:
        return "weights";
    case Mistake::TopLeft:
        return "topleft";
    default:
        return "none";
    }
}

std::optional<Mistake> mistake_from_name(std::string_view name)
{
    if (name == "none") return Mistake::None;
    for (Mistake m : kMistakes)
        if (name_of(m) == name) return m;
    return {};
}

PlantedMistake plant_mistake(RefinedMesh const& mesh, Mistake kind)
{
    Topology const& topology = mesh.base_topology();
    ControlMesh const& base = mesh.base();
    std::vector<std::string> warnings; // the patches gave them
    std::vector<char> const hidden = hidden_faces(mesh, warnings);
    std::vector<char> drawn(base.faces(), 0);
    for (std::uint32_t f = 0; f < hidden.size(); ++f)
        if (!hidden[f]) drawn[mesh.place(f).face] = 1;
    for (std::uint32_t f = 0; f < base.faces(); ++f) {
        bool shared = drawn[f] != 0;
        for (HalfEdge h = base.face_start[f]; h < base.face_start[f + 1]; ++h) {
            HalfEdge const twin = topology.twin(h);
            shared = shared && twin != Topology::kNone && drawn[topology.face_of(twin)];
        }
        if (shared) return {kind, f};
    }
    auto const first = std::find(drawn.begin(), drawn.end(), 1);
    return {kind, first == drawn.end() ? 0 : std::uint32_t(first - drawn.begin())};
}

namespace {

// Writes a record as load_column reads it.
template <class P> void store_column(P const& record, float* memory, std::size_t stride)
{
    for_each_scalar(record, [&](float scalar) {
        *memory = scalar;
        memory += stride;
    });
}

// How a form's hull shader leaves the control points that the cubics of a patch's edges are made
// of. A scheme's records may go on behind what is read of them here.
enum class EdgePoints {
    ByName,   ///< all p, then all e+, then all e-, each corner by corner
    ByCorner, ///< p, e+, e- of each corner in a record: CornerVectors
};

// None where the edges of the form's patches are no such cubics.
std::optional<EdgePoints> edge_points_of(PatchMesh const& patches)
{
    if (auto const* const form = dynamic_cast<StencilForm const*>(&patches)) {
        if (form->has_shared_edges()) return EdgePoints::ByName;
        return {};
    }
    if (dynamic_cast<TwoStageForm const*>(&patches)) return EdgePoints::ByCorner;
    return {};
}

// The control points of a patch in the order by name, as cubic_edge asks for them.
class ControlPointsByName {
public:
    /// \param floats  of a record
    ControlPointsByName(EdgePoints points, float const* memory, int floats, int sides)
        : points_(points),
          memory_(memory),
          floats_(floats),
          sides_(sides)
    {
    }
    ControlVertex<float> operator[](int i) const
    {
        if (points_ == EdgePoints::ByName) {
            int const packed = floats_ / 3; // into a record
            return load_record<ControlVertex<float>>(memory_ + i / packed * floats_ +
                                                     i % packed * 3);
        }
        auto const corner = load_record<CornerVectors<CornerLayout::kEMinus + 1, float>>(
            memory_ + i % sides_ * floats_);
        return {corner.vectors[std::size_t(i / sides_)]};
    }

private:
    EdgePoints points_;
    float const* memory_;
    int floats_, sides_;
};

// A domain program around a WatertightPatch's, which makes its mistake at the patch's edges.
class MistakenEdges final : public DomainProgram {
public:
    MistakenEdges(DomainShader right, Mistake mistake, EdgePoints points)
        : right_(std::move(right)),
          mistake_(mistake),
          points_(points)
    {
        assert(right_->patch_constant_floats() == scalar_count<EdgeRegister<float>>());
        assert(right_->output_floats() == scalar_count<SurfacePoint<float>>());
    }
    TessellatorDomain domain() const override { return right_->domain(); }
    int control_points() const override { return right_->control_points(); }
    int control_point_floats() const override { return right_->control_point_floats(); }
    int patch_constant_floats() const override { return right_->patch_constant_floats(); }
    OutputLayout output() const override { return right_->output(); }
    std::vector<ResourceInfo> resources(ShaderBinding const&) const override
    {
        return right_.resources();
    }

    void run(ShaderBinding const&, DomainBatch const& batch, StageCounters& counters) const override
    {
        DomainBatch b = batch;
        b.epilog = nullptr;
        std::vector<float> constants;
        if (mistake_ == Mistake::Order) {
            constants = own_direction(b);
            b.patch_constants = constants.data();
        }
        right_.run(b, counters);
        if (mistake_ == Mistake::Contraction) mirror_pairs(b);
        if (mistake_ == Mistake::Normals) own_normals(b, counters);
        if (batch.epilog) batch.epilog->run(batch, std::size_t(0), batch.points);
    }

private:
    using Point = SurfacePoint<float>;
    using Register = EdgeRegister<float>;
    int sides() const { return sides_of(right_->domain()); }

    // Edges walked in the patch's own direction: there the field W is -W, backwards.
    std::vector<float> own_direction(DomainBatch const& b) const
    {
        constexpr int kFloats = scalar_count<Register>();
        ControlPoints<Register> const registers(b.patch_constants, b.patch_constant_count);
        std::vector<float> out(b.patch_constants,
                               b.patch_constants + b.patch_constant_count * kFloats);
        for (int k = 0; k < sides(); ++k) {
            if (!(registers[4 * k].reversed > 0)) continue;
            for (int m = 0; m < 4; ++m)
                store_column(Register{-registers[4 * k + 3 - m].vector, 0},
                             out.data() + (4 * k + m) * kFloats, 1);
        }
        return out;
    }

    DomainEdges<4, float> edges_at(DomainBatch const& b, std::size_t i) const
    {
        float const u = b.u[i], v = b.v[i];
        return domain_edges<float>(sides(), u, v, 1 - u - v, 1 - u, 1 - v);
    }

    void mirror_pairs(DomainBatch const& b) const
    {
        using C = Contracted<float>;
        SiteState const saved = site_state;
        site_state = {Contraction::All, 0};
        int const n = sides();
        ControlPointsByName const points(points_, b.control_points, right_->control_point_floats(),
                                         n);
        for (std::size_t i = 0; i < b.points; ++i) {
            DomainEdges<4, float> const at = edges_at(b, i);
            for (int k = 0; k < n; ++k) {
                if (!at.on[k] || at.on[(k + 1) % n] || at.on[(k + n - 1) % n]) continue;
                C const t = at.t[k], s = C(1.0f) - t, ss = s * s, tt = t * t;
                C const m = C(3.0f) * C(s * t);
                C const b0 = ss * s, b1 = m * s, b2 = m * t, b3 = tt * t;
                EdgeCurve<float> const edge =
                    n == 4 ? cubic_edge<4>(points, k) : cubic_edge<3>(points, k);
                float3<C> const p0 = edge.p0, p1 = edge.p1, p2 = edge.p2, p3 = edge.p3;
                float3<C> const p = (b0 * p0 + b3 * p3) + (b1 * p1 + b2 * p2);
                auto point = load_column<Point>(b.outputs + i, b.stride);
                point.position = {p.x.value, p.y.value, p.z.value};
                store_column(point, b.outputs + i, b.stride);
            }
        }
        site_state = saved;
    }

    // On edges the normal of a point just inside, which is the patch's own.
    void own_normals(DomainBatch const& b, StageCounters& counters) const
    {
        std::size_t const stride = (b.points + 15) / 16 * 16; // whole groups of lanes
        std::vector<float> u(stride), v(stride),
            inside(stride * std::size_t(scalar_count<Point>()));
        for (std::size_t i = 0; i < b.points; ++i) {
            float const middle = sides() == 4 ? 0.5f : 1.0f / 3;
            u[i] = b.u[i] + 0x1p-16f * (middle - b.u[i]);
            v[i] = b.v[i] + 0x1p-16f * (middle - b.v[i]);
        }
        DomainBatch other = b;
        other.u = u.data();
        other.v = v.data();
        other.outputs = inside.data();
        other.stride = stride;
        right_.run(other, counters);
        for (std::size_t i = 0; i < b.points; ++i) {
            DomainEdges<4, float> const at = edges_at(b, i);
            bool on = false;
            for (int k = 0; k < sides(); ++k) on = on || at.on[k];
            if (!on) continue;
            auto point = load_column<Point>(b.outputs + i, b.stride);
            point.normal = load_column<Point>(inside.data() + i, stride).normal;
            store_column(point, b.outputs + i, b.stride);
        }
    }

    DomainShader right_;
    Mistake mistake_;
    EdgePoints points_;
};

// A word of a patch, see StencilPatchWords.
template <class Group> auto& word_of(Group& g, std::size_t patch, int which)
{
    int const count = StencilPatchWords::count(g.patches[patch].sides);
    return g.words[patch * std::size_t(count) + std::size_t(which)];
}

// The tables with the last bit of one weight flipped: the patch gets weights of its own. None where
// the points drown every last bit.
std::optional<StencilForm::Tables> flipped_weight(StencilForm const& form, std::size_t group,
                                                  std::size_t patch)
{
    StencilForm::Tables out = form.tables();
    StencilForm::Group& g = out.groups[group];
    std::uint32_t& first = word_of(g, patch, StencilPatchWords::kWeights);
    auto const rows = std::size_t(word_of(g, patch, StencilPatchWords::kRows)),
               inputs = std::size_t(g.inputs);
    // The type's weights and, behind them, its constants: up to where the next type begins.
    std::size_t const begin = first;
    std::size_t end = out.weights.size();
    for (StencilForm::Group const& other : out.groups)
        for (std::size_t p = 0; p < other.patches.size(); ++p)
            if (std::size_t const start = word_of(other, p, StencilPatchWords::kWeights);
                start > begin)
                end = std::min(end, start);
    std::vector<float> own(out.weights.begin() + std::ptrdiff_t(begin),
                           out.weights.begin() + std::ptrdiff_t(end));
    auto const weight_of = [&](std::size_t input, std::size_t row) -> float& {
        return own[input * rows + row];
    };
    // A last bit may drown in the sum's rounding: of the weights of the corners' limit points, the
    // first rows of the table, the first that changes its point.
    std::uint32_t const* const ids = g.indices.data() + patch * inputs;
    std::uint8_t const* const order = g.order.data() + patch * inputs;
    auto const sum = [&](std::size_t row) {
        glm::vec3 s(0);
        for (std::size_t k = 0; k < inputs; ++k)
            s += weight_of(order[k], row) * form.mesh().mesh().positions[ids[order[k]]];
        return s;
    };
    std::size_t const sides = g.patches[patch].sides;
    bool changed = false;
    for (std::size_t at = 0; at < inputs * sides && !changed; ++at) {
        std::size_t const row = at % sides;
        float& weight = weight_of(at / sides, row);
        float const right = weight;
        glm::vec3 const before = sum(row);
        weight = std::bit_cast<float>(std::bit_cast<std::uint32_t>(right) ^ 1u);
        changed = right != 0 && sum(row) != before;
        if (!changed) weight = right;
    }
    if (!changed) return {};
    first = std::uint32_t(out.weights.size());
    out.weights.insert(out.weights.end(), own.begin(), own.end());
    return out;
}

// The same of a wide patch, whose weights are its own: its corners' limit points are its first
// rows.
std::optional<StencilForm::Tables> flipped_wide_weight(StencilForm const& form, std::size_t group,
                                                       std::size_t patch)
{
    StencilForm::Tables out = form.tables();
    StencilForm::WideGroup& g = out.wide[group];
    auto const sum = [&](std::size_t row) {
        glm::vec3 s(0);
        for (std::size_t k = g.first[row]; k < g.first[row + 1]; ++k)
            s += g.weights[k] * form.mesh().mesh().positions[g.vertices[k]];
        return s;
    };
    std::size_t const first = patch * std::size_t(g.rows);
    for (std::size_t row = first; row < first + g.patches[patch].sides; ++row)
        for (std::size_t k = g.first[row]; k < g.first[row + 1]; ++k) {
            float const right = g.weights[k];
            glm::vec3 const before = sum(row);
            g.weights[k] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(right) ^ 1u);
            if (sum(row) != before) return out;
            g.weights[k] = right;
        }
    return {};
}

class MistakenPatches final : public PatchMesh {
public:
    MistakenPatches(PatchMesh const& right, PlantedMistake const& mistake)
        : PatchMesh(right.shared_mesh()),
          right_(right),
          mistake_(mistake)
    {
        switch (mistake.kind) {
        case Mistake::Order:
        case Mistake::Contraction:
        case Mistake::Normals:
            find_edges();
            break;
        case Mistake::Weights:
            plant_weight();
            break;
        default:
            break;
        }
    }

    CommandList commands(SurfaceSettings const& settings) const override
    {
        SurfaceSettings s = settings;
        // Mirror pairs are symmetric until products are fused.
        if (mistake_.kind == Mistake::Contraction) s.machine.contraction = Contraction::All;
        CommandList list = tables_ ? form_->commands(s, *tables_) : right_.commands(s);
        list.for_each_surface_draw([&](Draw& d) { plant(d); });
        return list;
    }
    std::vector<PatchCount> patch_counts() const override { return right_.patch_counts(); }
    bool has_creases() const override { return right_.has_creases(); }
    std::vector<std::string> warnings() const override { return right_.warnings(); }

    /// Whether a draw or a table has the mistake.
    bool planted(CommandList const& list) const
    {
        if (mistake_.kind == Mistake::Weights) return tables_.has_value();
        bool found = false;
        list.for_each_surface_draw([&](Draw const& d) {
            found = found ||
                    (mistake_.kind != Mistake::Factors && mistake_.kind != Mistake::Fold) ||
                    patch_of(d.patches);
        });
        return found;
    }

private:
    void plant(Draw& d) const
    {
        switch (mistake_.kind) {
        case Mistake::Order:
        case Mistake::Contraction:
        case Mistake::Normals:
            d.pipeline.domain_shader = {std::make_shared<MistakenEdges>(
                                            d.pipeline.domain_shader, mistake_.kind, *edge_points_),
                                        d.pipeline.domain_shader.binding()};
            break;
        case Mistake::Factors:
            if (auto const p = patch_of(d.patches)) d.options.mistakes.other_factor = *p;
            break;
        case Mistake::Fold:
            if (auto const p = patch_of(d.patches)) d.options.mistakes.reversed_winding = *p;
            break;
        case Mistake::TopLeft:
            d.options.mistakes.inclusive_edges = true;
            break;
        default:
            break;
        }
    }
    /// The first one of the face among these.
    std::optional<std::int64_t> patch_of(std::span<PatchPlace const> patches) const
    {
        for (std::size_t i = 0; i < patches.size(); ++i)
            if (patches[i].face == mistake_.face) return std::int64_t(i);
        return {};
    }
    void find_edges()
    {
        edge_points_ = edge_points_of(right_);
        if (!edge_points_)
            throw Error("the mistake '" + std::string(name_of(mistake_.kind)) +
                        "' is one of shared cubic edges, which the scheme's patches do not have");
    }
    void plant_weight()
    {
        form_ = dynamic_cast<StencilForm const*>(&right_);
        if (form_ && !form_->has_shared_edges())
            throw Error("the mistake 'weights' is one of shared points, which the scheme's patches "
                        "do not have");
        if (!form_)
            throw Error("the mistake 'weights' needs weights of one patch, which the stencil form "
                        "has: in other forms a vertex is the same for all its patches");
        StencilForm::Tables const& tables = form_->tables();
        for (std::size_t g = 0; g < tables.groups.size() && !tables_; ++g)
            if (auto const p = patch_of(tables.groups[g].patches))
                tables_ = flipped_weight(*form_, g, std::size_t(*p));
        for (std::size_t g = 0; g < tables.wide.size() && !tables_; ++g)
            if (auto const p = patch_of(tables.wide[g].patches))
                tables_ = flipped_wide_weight(*form_, g, std::size_t(*p));
    }

    PatchMesh const& right_;
    PlantedMistake mistake_;
    StencilForm const* form_ = nullptr;
    std::optional<StencilForm::Tables> tables_;
    std::optional<EdgePoints> edge_points_;
};

} // namespace

std::unique_ptr<PatchMesh> with_mistake(PatchMesh const& patches, PlantedMistake const& mistake,
                                        FrameSettings const& frame)
{
    auto const needs_tessellator = [&](std::string const& who) {
        throw Error("the mistake '" + std::string(name_of(mistake.kind)) +
                    "' is the tessellator's, which " + who + " does not have");
    };
    bool const of_tessellator = mistake.kind == Mistake::Factors || mistake.kind == Mistake::Fold;
    if (frame.direct3d10 && of_tessellator) needs_tessellator("the Direct3D 10 path");
    auto out = std::make_unique<MistakenPatches>(patches, mistake);
    // Throws where a draw has no place for it.
    CommandList const list = out->commands(surface_settings(frame));
    if (of_tessellator)
        list.for_each_surface_draw([&](Draw const& d) {
            if (!d.pipeline.hull_shader) needs_tessellator("the scheme");
        });
    if (!out->planted(list))
        throw Error("the mistake '" + std::string(name_of(mistake.kind)) +
                    "' has no place in the patches of face " +
                    std::to_string(patches.mesh().base().file_face(mistake.face) + 1) +
                    ": none is drawn, or the change drowns in rounding");
    return out;
}

namespace {

// Verdicts that must find a mistake where it shows (docs/watertight.md).
std::vector<std::string> found_by(Mistake mistake)
{
    switch (mistake) {
    case Mistake::Order:
        return {"position", "normal"};
    case Mistake::Contraction:
    case Mistake::Weights:
        return {"position"};
    case Mistake::Factors:
        return {"topology"};
    case Mistake::Normals:
        return {"normal"};
    case Mistake::Fold:
        return {"coverage", "raycast"};
    case Mistake::TopLeft:
        return {"coverage"};
    default:
        return {};
    }
}

// What changes nothing.
char const* no_trace_of(Mistake mistake)
{
    switch (mistake) {
    case Mistake::Factors:
        return "the factors come out as the same segments";
    case Mistake::Fold:
        return "no sample and no ray meets the patch";
    case Mistake::TopLeft:
        return "no sample lies on an edge";
    default:
        return "all shared points come out with the same bits; more of them lie inside edges of "
               "more segments";
    }
}

} // namespace

std::string why_not_found(Mistake mistake, std::vector<CheckedVerdict> const& verdicts)
{
    if (mistake == Mistake::None || !all_hold(verdicts)) return "";
    std::string const what = "the mistake '" + std::string(name_of(mistake)) + "' is not found: ";
    std::vector<std::string> const finders = found_by(mistake);
    std::string reason;
    for (CheckedVerdict const& v : verdicts) {
        if (std::find(finders.begin(), finders.end(), v.name) == finders.end()) continue;
        if (v.verdict == Verdict::Pass) return what + no_trace_of(mistake);
        if (reason.empty()) reason = v.reason;
    }
    std::string names;
    for (std::string const& name : finders) names += (names.empty() ? "" : " and ") + name;
    return what + names + (finders.size() == 1 ? " is" : " are") + " skipped, " + reason;
}

} // namespace tessemu
