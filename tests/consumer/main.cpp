// A program outside the tree: five lines on the installed library.
#include <emu/tessellator.h>

int main()
{
    tessemu::TessellatorState const state{};
    tessemu::TessellatedPatch patch;
    tessemu::tessellate(state, tessemu::process_tess_factors(state, {3, 3, 3, 3, 3, 3}), patch);
    return patch.points() == 16 ? 0 : 1;
}
