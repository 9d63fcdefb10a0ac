// SPDX-License-Identifier: Apache-2.0
#include "cli/run_output.h"

#include <cstdio>

namespace tessemu {

void print(std::string_view text)
{
    OutputFile out("-");
    out.write(text);
    out.close();
}

void print_message(std::string_view text)
{
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

RunOutput::RunOutput(std::string const& json, Session const& session)
    : result_(session.result),
      standard_output_("-")
{
    if (json.empty()) return;
    OutputFile file(json);
    refuse_same(file, "--json");
    json_.emplace(std::move(file));
}

// A file that standard output goes to would be replaced under it.
void RunOutput::refuse_same(OutputFile const& file, std::string const& option) const
{
    std::string const what = option + " is '" + file.path().string() + "', ";
    if (json_ && file.is_same(*json_)) throw WriteError(what + "where --json goes");
    if (!file.is_stream() && file.is_same(standard_output_))
        throw WriteError(what + "where standard output goes; '-' is standard output");
}

OutputFile& RunOutput::add(std::string const& path)
{
    OutputFile file(path);
    refuse_same(file, "-o");
    return files_.emplace_back(std::move(file));
}

void RunOutput::keep(std::string const& input) const
{
    auto const refuse = [&](OutputFile const& file, std::string const& option) {
        std::error_code no_such_file;
        if (!file.is_stream() && std::filesystem::equivalent(file.path(), input, no_such_file))
            throw WriteError(option + " is '" + file.path().string() + "', which the run reads");
    };
    if (json_) refuse(*json_, "--json");
    for (OutputFile const& file : files_) refuse(file, "-o");
}

void RunOutput::close_files()
{
    for (OutputFile& file : files_) file.close();
}

void RunOutput::put_in_place(std::string const& table)
{
    bool printed = json_ && json_->is_standard_output();
    for (OutputFile& file : files_) printed = printed || file.is_standard_output();
    if (json_) json_->close();
    if (!printed) print(table);
    for (OutputFile& file : files_) file.commit();
    if (json_) json_->commit();
}

} // namespace tessemu
