// tessemu: the program. Parses, calls a verb, prints errors.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/verbs.h"
#include "io/report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace tessemu;

namespace {

void add_surface_options(CLI::App& verb, Options& o)
{
    verb.add_option("--scheme", o.scheme, "patch scheme, see 'tessemu schemes'")
        ->capture_default_str();
    verb.add_option("--set", o.set, "NAME=VALUE: a parameter of the scheme");
    verb.add_option("--tess", o.tess, "tess factor of every edge and inside, above 0 to 64")
        ->capture_default_str();
    verb.add_option("--partitioning", o.partitioning,
                    "integer, pow2, fractional_odd, fractional_even")
        ->capture_default_str();
    verb.add_option("--normals", o.normals, "inside a patch: frozen (LOOP09 4.4) or true")
        ->capture_default_str();
    verb.add_option("--contraction", o.contraction,
                    "products that feed sums: none, all, mixed:SEED")
        ->capture_default_str();
    verb.add_option("--displace", o.displace,
                    "along the normal: studs, a pattern in space; or an image on the mesh's "
                    "texture coordinates; or none")
        ->capture_default_str();
    verb.add_option("--displace-scale", o.displace_scale,
                    "displacement of a white texel, in the model's units [0.01 of its diagonal]");
    verb.add_option("--animate", o.animate,
                    "sway: bones along the model's longest side, bent by a wave; or none")
        ->capture_default_str();
    verb.add_option("--phase", o.phase, "where the motion begins, in periods")
        ->capture_default_str();
    verb.add_option("--direct3d", o.direct3d,
                    "11: hull shader, tessellator, domain shader; 10: geometry shader, stream "
                    "output, instances (LOOP09 5)")
        ->check(CLI::IsMember({10, 11}))
        ->capture_default_str();
    verb.add_option("--lanes", o.lanes, "4, 8 or 16; changes no result")->capture_default_str();
    verb.add_option("-j", o.threads, "threads; 0: all cores")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    verb.add_option("--json", o.json, "write the result as JSON; '-' is standard output");
}

void add_vertex_cache(CLI::App& verb, Options& o)
{
    verb.add_option("--vertex-cache", o.vertex_cache, "none, fifo:N, lru:N, infinite")
        ->capture_default_str();
}

void add_picture_options(CLI::App& verb, Options& o)
{
    verb.add_option("--size", o.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
    verb.add_option("--camera", o.camera,
                    "auto, from=X,Y,Z, or eye=X,Y,Z:target=X,Y,Z:up=X,Y,Z:focal=F")
        ->capture_default_str();
    verb.add_option("--tess-edge", o.tess_edge,
                    "factors edge by edge: pixels=P, segments of about P pixels; distance=D, "
                    "--tess at distance D and falling with it; none: --tess everywhere")
        ->capture_default_str();
}

} // namespace

int main(int argc, char** argv)
{
    Options o;
    CLI::App app("The Direct3D 11 tessellation pipeline, emulated and counted.\n", "tessemu");
    std::string const version = "tessemu " + std::string(tessemu_version());
    app.set_version_flag("--version", version);
    app.require_subcommand(1);
    int (*run)(Options const&) = nullptr;
    auto const verb = [&](char const* name, char const* about, char const* examples,
                          int (*work)(Options const&)) {
        CLI::App* v = app.add_subcommand(name, about);
        v->set_version_flag("--version", version);
        v->footer(std::string("Examples:\n") + examples);
        v->callback([&run, work] { run = work; });
        return v;
    };

    CLI::App* draw = verb(
        "draw", "draw a control mesh and count what every stage does",
        "  tessemu draw jug -o jug.png\n"
        "  tessemu draw cage.obj --tess 16 --view patches -o patches.png --json counters.json\n"
        "  tessemu draw cage.obj --camera from=1,0.5,0 --size 1920x1080 -o side.exr\n"
        "  tessemu draw jug --tess 32 --displace studs -o studs.png\n"
        "  tessemu draw jug --animate sway --frames 12 -o sway.png --json sway.json\n"
        "  tessemu draw cage.obj --scheme acc --view error -o error.png",
        run_draw);
    draw->add_option("MODEL", o.model, "OBJ file or built-in cage, see 'tessemu models'")
        ->required();
    draw->add_option("-o", o.output, "picture, .png or .exr");
    add_picture_options(*draw, o);
    draw->add_option(
            "--view", o.view,
            "lit, normals, patches, depth, wire, coverage: how often a pixel is covered, before "
            "depth; cage: the control mesh; error: against the Catmull-Clark limit surface")
        ->capture_default_str();
    draw->add_option("--error-max", o.error_max,
                     "of the error view: POSITION,ANGLE that are red, in diagonals and radians; "
                     "auto: what 99 % of the area stays below")
        ->capture_default_str();
    draw->add_option("--level", o.level, "of the error view: 2^level segments an edge [4]")
        ->check(CLI::Range(1, 6));
    draw->add_option("--frames", o.frames,
                     "pictures of one period of the motion, numbered: NAME_0000.png and so on")
        ->capture_default_str();
    draw->add_option("--samples", o.samples, "1, 2, 4 or 8 samples a pixel, resolved")
        ->check(CLI::IsMember({1, 2, 4, 8}))
        ->capture_default_str();
    draw->add_option("--cull", o.cull, "none, back, front")->capture_default_str();
    add_surface_options(*draw, o);
    add_vertex_cache(*draw, o);

    CLI::App* exporter = verb("export", "write the tessellated mesh, patch by patch",
                              "  tessemu export jug --tess 8 -o jug.ply\n"
                              "  tessemu export cage.obj --tess 4 --weld -o cage4.obj",
                              run_export);
    exporter->add_option("MODEL", o.model, "OBJ file or built-in cage")->required();
    exporter->add_option("-o", o.output, "mesh, .obj or .ply")->required();
    exporter->add_flag("--weld", o.weld, "join vertices with equal bits");
    add_surface_options(*exporter, o);
    add_vertex_cache(*exporter, o);

    CLI::App* tess =
        verb("tessellate", "run the fixed-function tessellator alone",
             "  tessemu tessellate --factors 3 3 3 3 3 3\n"
             "  tessemu tessellate --domain tri --partitioning integer --factors 2 2 2 4\n"
             "  tessemu tessellate --batch cases.txt > answers.txt",
             run_tessellate);
    tess->add_option("--domain", o.domain, "quad, tri, isoline")->capture_default_str();
    tess->add_option("--partitioning", o.partitioning,
                     "integer, pow2, fractional_odd, fractional_even")
        ->capture_default_str();
    tess->add_option("--output", o.primitive, "point, line, triangle_cw, triangle_ccw")
        ->capture_default_str();
    CLI::Option* factors =
        tess->add_option("--factors", o.factors,
                         "quad: edges u=0 v=0 u=1 v=1, inside u v; tri: u=0 v=0 w=0, inside; "
                         "isoline: density, detail");
    CLI::Option* batch =
        tess->add_option("--batch", o.batch, "file of cases, one a line; '-' is standard input");
    factors->excludes(batch);
    tess->add_option("-o,--json", o.output, "file for the result instead of standard output");

    CLI::App* compare =
        verb("compare", "distance and normal error against the Catmull-Clark limit surface",
             "  tessemu compare cage.obj\n"
             "  tessemu compare cage.obj --scheme acc --level 5 --json acc.json",
             run_compare);
    compare->add_option("MODEL", o.model, "OBJ file or built-in cage")->required();
    compare->add_option("--level", o.level, "both surfaces at 2^level segments an edge [4]")
        ->check(CLI::Range(1, 6));
    compare->add_option("--scheme", o.scheme, "patch scheme, see 'tessemu schemes'")
        ->capture_default_str();
    compare->add_option("--set", o.set, "NAME=VALUE: a parameter of the scheme");
    compare->add_option("--normals", o.normals, "inside a patch: frozen (LOOP09 4.4) or true")
        ->capture_default_str();
    compare
        ->add_option("--contraction", o.contraction,
                     "products that feed sums: none, all, mixed:SEED")
        ->capture_default_str();
    compare->add_option("--lanes", o.lanes, "4, 8 or 16; changes no result")->capture_default_str();
    compare->add_option("-j", o.threads, "threads; 0: all cores")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    compare->add_option("--json", o.json, "write the result as JSON; '-' is standard output");

    CLI::App* check =
        verb("check",
             "is the surface closed? Verdicts on edges, coverage and rays; exit status 1 if one "
             "fails",
             "  tessemu check golem\n"
             "  tessemu check cage.obj --tess 7.3 --contraction mixed:5 --displace studs\n"
             "  tessemu check golem --break order --parity 0.02 -o cracks.png --json cracks.json",
             run_check);
    check->add_option("MODEL", o.model, "OBJ file or built-in cage")->required();
    check->add_option("-o", o.output, "the lit picture with cracks in red, .png or .exr");
    check
        ->add_option("--break", o.mistake,
                     "plant a known mistake: order, contraction, factors, normals, fold, weights, "
                     "topleft")
        ->capture_default_str();
    check
        ->add_option(
            "--break-face", o.mistaken_face,
            "whose patch has it, where it is one patch's [the first that shares all edges]")
        ->check(CLI::Range(std::int64_t(0), std::int64_t(1) << 32));
    check->add_option(
        "--parity", o.parity,
        "move every point by so much along its normal, out or in by the parity of its "
        "bits: cracks of one ulp open [0]");
    check->add_option("--rays", o.rays, "of each kind; 0: none")
        ->check(CLI::Range(std::int64_t(0), std::int64_t(1000000000)))
        ->capture_default_str();
    add_picture_options(*check, o);
    add_surface_options(*check, o);

    CLI::App* cost =
        verb("cost", "predicted time by stage on a described machine, and what bounds it",
             "  tessemu cost jug --tess 16\n"
             "  tessemu cost cage.obj --direct3d 10 --geometry-only -o roofline.png\n"
             "  tessemu cost cage.obj --machine my_machine.json --json cost.json",
             run_cost);
    cost->add_option("MODEL", o.model, "OBJ file or built-in cage")->required();
    cost->add_option("--machine", o.machine, "a file, or gtx260 or loop09-emulator")
        ->capture_default_str();
    cost->add_option("-o", o.output, "roofline picture, .png or .exr");
    cost->add_flag("--geometry-only", o.geometry_only, "without rasterization");
    add_picture_options(*cost, o);
    add_surface_options(*cost, o);

    CLI::App* reproduce =
        verb("reproduce", "a paper's table or figure: its numbers, ours and the ratio; or pictures",
             "  tessemu reproduce loop09-table1\n"
             "  tessemu reproduce loop09-table3 --models cages\n"
             "  tessemu reproduce loop09-figure9 -o figure9.png",
             run_reproduce);
    reproduce
        ->add_option("NAME", o.reproduce,
                     "loop09-table1, -table2, -table3, -figure1, -figure3, -figure9, -figure10, "
                     "-figure11, -figure12")
        ->required();
    reproduce
        ->add_option("--models", o.models,
                     "folder with the paper's cages, bigguy.obj and monsterfrog.obj: needed by "
                     "tables 2 and 3, shown by figures 9, 11 and 12 where they are there")
        ->capture_default_str();
    reproduce->add_option("-o", o.output, "of a figure: picture, .png or .exr [NAME.png]");
    reproduce
        ->add_option("--level", o.level, "of table 3: surfaces at 2^level segments an edge [3]")
        ->check(CLI::Range(1, 6));
    reproduce->add_option("-j", o.threads, "threads; 0: all cores")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    reproduce->add_option("--json", o.json, "write the result as JSON; '-' is standard output");

    CLI::App* diff =
        verb("diff", "two results side by side; exit status 1 where they differ",
             "  tessemu draw jug --json now.json && tessemu diff golden.json now.json\n"
             "  tessemu diff acc.json gregory.json --all\n"
             "  tessemu diff golden.json now.json --tolerance 0.01",
             run_diff);
    diff->add_option("A", o.model, "a result, as --json writes it")->required();
    diff->add_option("B", o.other, "another")->required();
    diff->add_option("--tolerance", o.tolerance,
                     "numbers may differ by this share of the larger one; above 0, hashes are not "
                     "compared")
        ->capture_default_str();
    diff->add_flag("--all", o.all, "show equal values too");
    diff->add_option("--json", o.json, "write the result as JSON; '-' is standard output");

    CLI::App* info = verb("info", "figures of a control mesh and of its patches",
                          "  tessemu info jug\n  tessemu info cage.obj --json info.json", run_info);
    info->add_option("MODEL", o.model, "OBJ file or built-in cage")->required();
    info->add_option("--scheme", o.scheme, "patch scheme")->capture_default_str();
    info->add_option("--json", o.json, "write the result as JSON; '-' is standard output");

    verb("schemes", "list the patch schemes", "  tessemu schemes", run_schemes);
    verb("models", "list the built-in control meshes", "  tessemu models", run_models);

    // A verb that needs an argument, given none, shows its help.
    if (argc == 1) {
        fmt::print(stderr, "{}", app.help());
        return 2;
    }
    if (argc == 2)
        for (CLI::App* v : {draw, exporter, tess, compare, check, cost, reproduce, diff, info})
            if (v->get_name() == argv[1]) {
                fmt::print(stderr, "{}", v->help());
                return 2;
            }
    try {
        app.parse(argc, argv);
    } catch (CLI::ParseError const& e) {
        if (e.get_exit_code() == 0) return app.exit(e);
        if (app.get_subcommands().empty()) { // CLI11 does not say which word it did not know
            std::string verbs;
            for (CLI::App const* v : app.get_subcommands({})) verbs += " " + v->get_name();
            fmt::print(stderr, "tessemu: '{}' is not a verb; there are{}\n", argv[1], verbs);
            return 2;
        }
        fmt::print(stderr, "tessemu: {}\n", e.what());
        return 2;
    }
    try {
        return run(o);
    } catch (std::exception const& e) {
        fmt::print(stderr, "tessemu: {}\n", e.what());
        return 2;
    }
}
