// Facts S16 to S24 and gap G10: the input assembler, and formats as vertex elements.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/texture.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <numeric>

namespace tessemu::test {
namespace {

std::uint32_t word_at(Scene const& s, int x, int y)
{
    std::uint32_t word;
    std::memcpy(&word, s.color.texel(x, y), 4);
    return word;
}

template <class Index> void draw_two_strips()
{
    constexpr Index kCut = std::numeric_limits<Index>::max();
    std::vector<Index> const indices{0, 1, 2, 3, kCut, 4, 5, 6, 7};
    Scene s(640, 480, 1, Format::R8G8B8A8_UNORM);
    s.call.topology = PrimitiveTopology::TriangleStrip;
    for (float x : {0.0f, 240.0f, 400.0f, 640.0f})
        for (float y : {480.0f, 0.0f}) {
            bool const left = x < 320;
            s.add(x, y, 0.5f, 1, {left ? 0.0f : 1.0f, left ? 1.0f : 0, left ? 1.0f : 0, 1});
        }
    s.clear({0.25f, 0.5f, 0.75f, 1});
    std::uint32_t const untouched = word_at(s, 0, 0);
    s.call.indices = std::span<Index const>(indices);
    EXPECT_EQ(s.draw().pipeline.IAPrimitives, 4u);
    for (int y = 0; y < 480; ++y)
        for (int x = 0; x < 640; ++x)
            ASSERT_EQ(word_at(s, x, y), x < 240   ? 0xffffff00u
                                        : x < 400 ? untouched
                                                  : 0xff0000ffu)
                << x << ' ' << y;
}

TEST(InputAssemblerFacts, S16TheAllOnesIndexCutsAStripInTwo)
{
    draw_two_strips<std::uint16_t>();
    draw_two_strips<std::uint32_t>();
}

// Vertex ids of the primitives, and how many there are.
std::vector<std::uint32_t> assembled(DrawCall const& call)
{
    AssembledPrimitives const p = assemble_primitives(call);
    std::vector<std::uint32_t> out;
    for (std::uint32_t id : p.vertices) out.push_back(p.index(id));
    return out;
}

TEST(InputAssemblerFacts, S17TheAllOnesIndexCutsAListTooWhichLeavesOneTriangleOfThree)
{
    std::vector<std::uint32_t> const indices{0, 1, ~0u, 9, ~0u, ~0u, 2000, 3000, 4000};
    DrawCall call;
    call.topology = PrimitiveTopology::TriangleList;
    call.indices = std::span<std::uint32_t const>(indices);
    EXPECT_EQ(assembled(call), (std::vector<std::uint32_t>{2000, 3000, 4000}));
    call.index_cut = IndexCut::StripsOnly; // as drivers have it
    EXPECT_EQ(assembled(call), indices);
}

TEST(InputAssemblerFacts, S18G10IndicesStartWhereTheBufferDoesAndPastItsEndTheyAreZero)
{
    using V = std::vector<std::uint32_t>;
    V const indices{0, 1, 2, 3, 3, 2, 1, 0, 1, 3, 2, 0};
    DrawCall call;
    call.topology = PrimitiveTopology::PointList;
    call.index_count = 4;
    for (std::uint32_t offset : {0u, 4u, 8u}) {
        V const expected(indices.begin() + offset, indices.begin() + offset + 4);
        call.indices = std::span<std::uint32_t const>(indices).subspan(offset);
        call.start_index = 0;
        EXPECT_EQ(assembled(call), expected);
        call.indices = std::span<std::uint32_t const>(indices);
        call.start_index = offset;
        EXPECT_EQ(assembled(call), expected);
    }
    call.start_index = 10;
    EXPECT_EQ(assembled(call), (V{2, 0, 0, 0}));
    call.start_index = 1000;
    EXPECT_EQ(assembled(call), (V{0, 0, 0, 0}));
    call.start_index = 0;
    call.index_count = 5;
    for (auto topology : {PrimitiveTopology::TriangleList, PrimitiveTopology::TriangleStrip}) {
        call.topology = topology;
        call.indices = std::span<std::uint32_t const>(); // an indexed draw without a buffer
        V const zeros(topology == PrimitiveTopology::TriangleList ? 3 : 9, 0u);
        EXPECT_EQ(assembled(call), zeros);
        call.indices = std::span<std::uint16_t const>();
        EXPECT_EQ(assembled(call), zeros);
    }
    call.index_count = 0xfffffffeu; // memory for so many is not asked for
    EXPECT_THROW(assembled(call), LimitError);
    call.index_count = kAllIndices;
    EXPECT_TRUE(assembled(call).empty());
}

// A vertex as the input layout's scalars.
std::vector<float> fetched(DrawCall const& call, std::uint32_t vertex, std::uint32_t instance = 0)
{
    std::vector<float> out(std::size_t(call.vertex_floats()));
    fetch_vertex(call, vertex, instance, out.data());
    return out;
}

TEST(InputAssemblerFacts, S19StridesMayBeLessThanTheElementAndAnElementPastTheEndIsZero)
{
    std::vector<float> numbers(64);
    std::iota(numbers.begin(), numbers.end(), 0.0f);
    auto const vertex = [&](std::uint32_t stride, std::size_t size, std::uint32_t i) {
        DrawCall call;
        call.vertex_buffers = {{std::as_bytes(std::span(numbers)).first(size), stride, 0}};
        call.layout = {{Format::R32G32B32A32_FLOAT, 4, 0, 16, false, 1}};
        return fetched(call, i);
    };
    auto const run = [](float from) {
        return std::vector<float>{from, from + 1, from + 2, from + 3};
    };
    std::vector<float> const zeros(4, 0.0f);
    EXPECT_EQ(vertex(0, 32, 0), run(4));
    EXPECT_EQ(vertex(0, 32, 1), run(4));
    for (std::uint32_t stride : {4u, 8u, 12u}) {
        std::size_t const size = 32 + stride; // just what two vertices need
        EXPECT_EQ(vertex(stride, size, 0), run(4));
        EXPECT_EQ(vertex(stride, size, 1), run(4 + float(stride) / 4));
        EXPECT_EQ(vertex(stride, size, 2), zeros);
        EXPECT_EQ(vertex(stride, size - 1, 1), zeros);
    }
    for (std::size_t size : {4u, 15u, 16u})
        for (std::uint32_t stride : {0u, 4u, 16u}) EXPECT_EQ(vertex(stride, size, 0), zeros);
}

// The instance's colour, and its number.
struct InstanceColor {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(VertexInput<T> const& in, SceneVertex<T> const& v) const
    {
        SceneVertex<T> o = v;
        o.value.w = T(float(in.instance_id));
        return o;
    }
};

TEST(InputAssemblerFacts, S20InstanceDataStepAtTheirOwnRatesFromTheFirstInstanceOn)
{
    std::vector<std::uint8_t> const bytes{0xf0, 0x80, 0x10, 0x40, 0xaa, 0xbb, 0xcc, 0x90};
    std::vector<float> const corner{0, 0, 0.5f, 1};
    DrawCall call;
    call.topology = PrimitiveTopology::PointList;
    call.vertex_buffers = {{std::as_bytes(std::span(corner)), 16, 0},
                           {std::as_bytes(std::span(bytes)), 1, 0},
                           {std::as_bytes(std::span(corner)), 0, 12}};
    call.layout = {{Format::R32G32B32A32_FLOAT, 4, 0, 0, false, 1},
                   {Format::R8_UNORM, 1, 1, 0, true, 1},
                   {Format::R8_UNORM, 1, 1, 0, true, 0},
                   {Format::R8_UNORM, 1, 1, 0, true, 2},
                   {Format::R32_FLOAT, 1, 2, 0, false, 1}};
    call.vertex_count = 1;
    call.instance_count = 4;
    GraphicsPipelineDesc desc;
    desc.vertex_shader = bind_vertex_shader(InstanceColor{}, {});
    desc.stream_output = StreamOutputDesc{{{0, 4, 4, 0}}, {}, -1};
    std::vector<std::byte> memory(1024);
    StreamOutputBuffer buffer{memory, 0};
    DrawOptions options;
    options.stream_output = {&buffer, 1};
    for (std::uint32_t start : {0u, 4u}) {
        call.start_instance = start;
        draw(GraphicsPipeline(desc), call, nullptr, {}, ThreadPool(1), options);
    }
    std::uint32_t const expected[] = {0xf0f0f0, 0xf0f080, 0x80f010, 0x80f040,
                                      0xaaaaaa, 0xaaaabb, 0xbbaacc, 0xbbaa90}; // blue first
    ASSERT_EQ(buffer.filled, 8u * 16);
    for (std::size_t i = 0; i < 8; ++i) {
        float v[4];
        std::memcpy(v, memory.data() + 16 * i, 16);
        EXPECT_EQ(unorm_from_float(v[2], 8) << 16 | unorm_from_float(v[1], 8) << 8 |
                      unorm_from_float(v[0], 8),
                  expected[i]);
        EXPECT_EQ(v[3], float(i % 4));
    }
}

TEST(InputAssemblerFacts, S21ASlotWithoutABufferGivesZerosAlphaToo)
{
    for (Format format : {Format::R32G32B32A32_FLOAT, Format::R8G8B8A8_UNORM, Format::R32_FLOAT,
                          Format::R16G16B16A16_UINT}) {
        DrawCall call;
        call.layout = {{format, 4, 7, 0, false, 1}}; // beyond the buffers that are set
        EXPECT_EQ(fetched(call, 0), std::vector<float>(4, 0.0f));
        call.vertex_buffers.resize(8);
        EXPECT_EQ(fetched(call, 0), std::vector<float>(4, 0.0f));
    }
}

// An element of a format, as a vertex fetch sees it.
std::vector<float> element(Format format, std::vector<std::uint32_t> const& words)
{
    DrawCall call;
    call.vertex_buffers = {{std::as_bytes(std::span(words)), 16, 0}};
    call.layout = {{format, 4, 0, 0, false, 1}};
    check_draw_call(call);
    return fetched(call, 0);
}
std::uint32_t bits(float f)
{
    return std::bit_cast<std::uint32_t>(f);
}
// Within one ulp, as the suite has it: its numbers are printed with nine digits, so each is the
// float that it stands for.
void expect_numbers(Format format, std::vector<float> const& seen, std::vector<float> const& wanted)
{
    ASSERT_EQ(seen.size(), wanted.size());
    for (std::size_t i = 0; i < seen.size(); ++i)
        EXPECT_LE(std::abs(std::int64_t(bits(seen[i])) - std::int64_t(bits(wanted[i]))), 1)
            << info(format).name << " component " << i << " is " << seen[i];
}
// Bytes 21 43 65 87, 78 56 34 12, cc cc cc cc, ef be ad de.
std::vector<std::uint32_t> const kBytes{0x87654321, 0x12345678, 0xcccccccc, 0xdeadbeef};

TEST(InputAssemblerFacts, S22ElementsDecodeToTheNumbersOfTheSuite)
{
    auto const expect = [](Format f, std::vector<float> const& wanted) {
        expect_numbers(f, element(f, kBytes), wanted);
    };
    expect(Format::R11G11B10_FLOAT, {0.189453125f, 13, 3.8125f, 1});
    expect(Format::R16G16B16A16_FLOAT, {3.56445313f, -1.12831593e-4f, 103.5f, 7.57217407e-4f});
    expect(Format::R16G16B16A16_UNORM, {0.262226284f, 0.528892934f, 0.33777371f, 0.0711070448f});
    expect(Format::R16G16B16A16_SNORM, {0.524460614f, -0.942258954f, 0.675557733f, 0.14221625f});
    expect(Format::R8G8B8A8_UNORM, {0.129411772f, 0.262745112f, 0.396078438f, 0.529411793f});
    expect(Format::R8G8B8A8_SNORM, {0.259842515f, 0.527559042f, 0.795275569f, -0.952755928f});
    std::vector<float> const whole = element(Format::R32G32B32A32_UINT, kBytes);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bits(whole[i]), kBytes[i]);
}

TEST(InputAssemblerFacts, S23ElementsOfTenTwoAndOneComponentsAndBlueFirstDecodeToo)
{
    auto const expect = [](Format f, std::vector<float> const& wanted) {
        expect_numbers(f, element(f, kBytes), wanted);
    };
    expect(Format::R10G10B10A2_UNORM, {0.78299123f, 0.328445762f, 0.11534702f, 0.666666667f});
    expect(Format::B8G8R8A8_UNORM, {0.396078438f, 0.262745112f, 0.129411772f, 0.529411793f});
    expect(Format::R16_SNORM, {0.524460614f, 0, 0, 1});
    // Of the same bytes, by the same numbers.
    expect(Format::B8G8R8X8_UNORM, {0.396078438f, 0.262745112f, 0.129411772f, 1});
    expect(Format::R16_UNORM, {0.262226284f, 0, 0, 1});
    expect(Format::R16_FLOAT, {3.56445313f, 0, 0, 1});
    expect(Format::R16G16_UNORM, {0.262226284f, 0.528892934f, 0, 1});
    expect(Format::R16G16_SNORM, {0.524460614f, -0.942258954f, 0, 1});
    expect(Format::R8G8_UNORM, {0.129411772f, 0.262745112f, 0, 1});
    expect(Format::R8G8_SNORM, {0.259842515f, 0.527559042f, 0, 1});
    expect(Format::R8_UNORM, {0.129411772f, 0, 0, 1});
    expect(Format::R8_SNORM, {0.259842515f, 0, 0, 1});
    auto const expect_words = [](Format f, std::array<std::uint32_t, 4> const& wanted) {
        std::vector<float> const seen = element(f, kBytes);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_EQ(bits(seen[i]), wanted[i]) << info(f).name << " " << i;
    };
    expect_words(Format::R10G10B10A2_UINT, {0x321, 0x150, 0x076, 2});
    expect_words(Format::R32G32B32_UINT, {kBytes[0], kBytes[1], kBytes[2], 1});
    expect_words(Format::R32G32B32_SINT, {kBytes[0], kBytes[1], kBytes[2], 1});
    expect_words(Format::R32G32_UINT, {kBytes[0], kBytes[1], 0, 1});
    expect_words(Format::R32G32_SINT, {kBytes[0], kBytes[1], 0, 1});
    expect_words(Format::R16G16_UINT, {0x4321, 0x8765, 0, 1});
    expect_words(Format::R16G16_SINT, {0x4321, 0xffff8765, 0, 1});
    expect_words(Format::R16_UINT, {0x4321, 0, 0, 1});
    expect_words(Format::R16_SINT, {0x4321, 0, 0, 1});
    expect_words(Format::R8G8B8A8_UINT, {0x21, 0x43, 0x65, 0x87});
    expect_words(Format::R8G8B8A8_SINT, {0x21, 0x43, 0x65, 0xffffff87});
    expect_words(Format::R8G8_UINT, {0x21, 0x43, 0, 1});
    expect_words(Format::R8G8_SINT, {0x21, 0x43, 0, 1});
    expect_words(Format::R8_UINT, {0x21, 0, 0, 1});
    expect_words(Format::R8_SINT, {0x21, 0, 0, 1});
    EXPECT_THROW(element(Format::B8G8R8A8_UNORM_SRGB, kBytes), Error);
    EXPECT_THROW(element(Format::R8G8B8A8_UNORM_SRGB, kBytes), Error);
}

TEST(InputAssemblerFacts, S24TheLowestSnormCodesAreMinusOneAndUnormIsADivision)
{
    std::vector<std::uint32_t> const bytes{0x407f0080}; // -128, 0, 127, 64
    EXPECT_EQ(element(Format::R8G8B8A8_SNORM, bytes), (std::vector<float>{-1, 0, 1, 64.0f / 127}));
    EXPECT_EQ(element(Format::R8_SNORM, bytes)[0], -1.0f);
    EXPECT_EQ(element(Format::R16_SNORM, {0x8000})[0], -1.0f);
    EXPECT_EQ(element(Format::R16_SNORM, {0x8001})[0], -1.0f);
    EXPECT_EQ(element(Format::R16_UNORM, {16383})[0], 16383.0f / 65535);
    EXPECT_EQ(element(Format::R16G16B16A16_UNORM, {16383, 0})[0], 16383.0f / 65535);
}

TEST(InputAssemblerFacts, G10ASamplerThatNobodySetsIsDirect3DsDefaultSampler)
{
    // Two levels of one channel: 0 8 and, for a row of its own, 16.
    std::vector<float> const texels{0, 0, 0, 0, 8, 0, 0, 0, 16, 0, 0, 0};
    Texture2D const texture(texels, 2, 1, 0, "texture", 2);
    auto const at = [&](float u, float lod) {
        return sample_level<float>(texture, Sampler{}, {u, 0.5f}, lod).x;
    };
    EXPECT_EQ(at(0.25f, 0), 0.0f);
    EXPECT_EQ(at(0.5f, 0), 4.0f);     // linear
    EXPECT_EQ(at(-3, 0), 0.0f);       // clamped
    EXPECT_EQ(at(7, 0), 8.0f);        // clamped
    EXPECT_EQ(at(0.5f, 0.5f), 10.0f); // linear from level to level, without a bias
    EXPECT_EQ(at(0.5f, 9), 16.0f);    // up to the last level
}

} // namespace
} // namespace tessemu::test
