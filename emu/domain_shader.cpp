// SPDX-License-Identifier: Apache-2.0
#include "emu/domain_shader.h"

namespace tessemu {

namespace {

class FinishedDomainProgram final : public DomainProgram {
public:
    FinishedDomainProgram(std::shared_ptr<DomainProgram const> shader,
                          std::shared_ptr<DomainEpilog const> epilog)
        : shader_(std::move(shader)),
          epilog_(std::move(epilog))
    {
    }
    TessellatorDomain domain() const override { return shader_->domain(); }
    int control_points() const override { return shader_->control_points(); }
    int control_point_floats() const override { return shader_->control_point_floats(); }
    int patch_constant_floats() const override { return shader_->patch_constant_floats(); }
    OutputLayout output() const override { return epilog_->output(); }
    std::vector<ResourceInfo> resources() const override
    {
        std::vector<ResourceInfo> all = shader_->resources();
        for (ResourceInfo& r : epilog_->resources()) all.push_back(std::move(r));
        return all;
    }
    SiteState sites() const override { return shader_->sites(); }
    void run(DomainBatch const& batch, int patch_constants, StageCounters& counters) const override
    {
        DomainBatch b = batch;
        b.epilog = epilog_.get();
        shader_->run(b, patch_constants, counters);
    }

private:
    std::shared_ptr<DomainProgram const> shader_;
    std::shared_ptr<DomainEpilog const> epilog_;
};

} // namespace

std::shared_ptr<DomainProgram const> with_epilog(std::shared_ptr<DomainProgram const> shader,
                                                 std::shared_ptr<DomainEpilog const> epilog)
{
    if (shader->output_floats() != epilog->input_floats())
        throw Error("the domain shader gives " + std::to_string(shader->output_floats()) +
                    " scalars, its epilog takes " + std::to_string(epilog->input_floats()));
    // Outputs replace inputs in place.
    if (epilog->output().floats < epilog->input_floats())
        throw Error("a domain shader's epilog gives " + std::to_string(epilog->output().floats) +
                    " scalars, at least the " + std::to_string(epilog->input_floats()) +
                    " that it takes are needed");
    return std::make_shared<FinishedDomainProgram>(std::move(shader), std::move(epilog));
}

} // namespace tessemu
