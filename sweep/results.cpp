// SPDX-License-Identifier: Apache-2.0
#include "sweep/results.h"

#include "io/output_file.h"
#include "sweep/manifest.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <mutex>
#include <system_error>
#include <unordered_map>
#include <unordered_set>

#include <fcntl.h>
#include <unistd.h>

namespace tessemu {

using Json = nlohmann::ordered_json;

namespace {

// What every line begins with.
constexpr std::string_view kCase = "{\"case\":\"", kStatus = "\",\"status\":\"";
constexpr std::size_t kId = 64;

[[noreturn]] void fail(std::filesystem::path const& path, int error)
{
    throw WriteError(path.string() + ": " + std::generic_category().message(error));
}

} // namespace

struct ResultLog::Impl {
    std::filesystem::path folder, path;
    std::mutex mutex;
    int file = -1;

    void make()
    {
        char host[256] = {};
        gethostname(host, sizeof host - 1);
        auto const now = std::chrono::system_clock::now().time_since_epoch();
        auto const microseconds =
            std::chrono::duration_cast<std::chrono::microseconds>(now).count();
        path = folder / fmt::format("{}-{}-{}.jsonl", microseconds, host, getpid());
        file = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
        if (file < 0) fail(path, errno);
    }
};

ResultLog::ResultLog(std::filesystem::path folder) : impl_(std::make_unique<Impl>())
{
    impl_->folder = std::move(folder);
}

ResultLog::~ResultLog()
{
    if (impl_->file >= 0) close(impl_->file);
}

void ResultLog::add(CaseRecord const& r)
{
    std::string line = fmt::format("{}{}{}{}\",", kCase, r.id, kStatus, r.done ? "done" : "failed");
    if (r.done)
        line += "\"result\":" + r.text;
    else // a path in a message may be any bytes
        line += "\"message\":" + Json(r.text).dump(-1, ' ', false, Json::error_handler_t::replace);
    line += "}\n";
    std::scoped_lock const lock(impl_->mutex);
    if (impl_->file < 0) impl_->make();
    off_t const before = lseek(impl_->file, 0, SEEK_END);
    for (std::string_view rest = line; !rest.empty();) {
        ssize_t const n = write(impl_->file, rest.data(), rest.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            int const error = errno;
            if (ftruncate(impl_->file, before) != 0) impl_->file = -1; // the next begins a new file
            fail(impl_->path, error);
        }
        rest.remove_prefix(std::size_t(n));
    }
}

void ResultLog::flush()
{
    std::scoped_lock const lock(impl_->mutex);
    if (impl_->file >= 0 && fsync(impl_->file) != 0) fail(impl_->path, errno);
}

void ResultReader::read_lines(
    std::function<void(std::string_view line, std::string const& file)> const& take)
{
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (auto const& e : std::filesystem::directory_iterator(folder_, error))
        if (e.path().extension() == ".jsonl") files.push_back(e.path());
    if (error) throw FormatError(folder_.string(), 0, error.message());
    std::sort(files.begin(), files.end());
    for (std::filesystem::path const& path : files) {
        std::uint64_t& begin = read_[path.filename().string()];
        std::error_code gone;
        if (std::filesystem::file_size(path, gone) == begin || gone) continue;
        std::ifstream in(path, std::ios::binary);
        in.seekg(std::streamoff(begin));
        std::string line;
        while (std::getline(in, line)) {
            if (in.eof()) break; // not ended: by a run that goes on, or was killed
            begin += line.size() + 1;
            take(line, path.string());
        }
    }
}

namespace {
bool is_done(std::string_view line, std::string const& file)
{
    std::size_t const status = kCase.size() + kId;
    if (line.starts_with(kCase) &&
        line.substr(std::min(status, line.size())).starts_with(kStatus)) {
        std::string_view const word = line.substr(status + kStatus.size());
        if (word.starts_with("done\"")) return true;
        if (word.starts_with("failed\"")) return false;
    }
    throw FormatError(file, 0,
                      "this is no result of a sweep: '" + std::string(line.substr(0, 60)) + "'");
}
} // namespace

void ResultReader::read_states(std::function<void(std::string const& id, bool done)> const& take)
{
    read_lines([&](std::string_view line, std::string const& file) {
        bool const done = is_done(line, file);
        take(std::string(line.substr(kCase.size(), kId)), done);
    });
}

void ResultReader::read(std::function<void(CaseRecord const& record)> const& take)
{
    read_lines([&](std::string_view line, std::string const& file) {
        CaseRecord r{"", is_done(line, file), ""};
        r.id = line.substr(kCase.size(), kId);
        std::size_t const colon =
            line.find(r.done ? "\"result\":" : "\"message\":", kCase.size() + kId);
        if (colon == std::string_view::npos || !line.ends_with('}'))
            throw FormatError(file, 0, "the result of case " + r.id + " is damaged");
        std::string_view const value = line.substr(line.find(':', colon) + 1);
        r.text = value.substr(0, value.size() - 1);
        if (!r.done) {
            Json const message = Json::parse(r.text, nullptr, false);
            r.text = message.is_string() ? message.get<std::string>() : r.text;
        }
        take(r);
    });
}

std::vector<CaseRecord> failures(SweepManifest const& manifest, std::filesystem::path const& folder)
{
    std::unordered_map<std::string, std::string> messages;
    std::unordered_set<std::string> done;
    ResultReader(folder / "results").read([&](CaseRecord const& r) {
        if (r.done)
            done.insert(r.id);
        else
            messages[r.id] = r.text;
    });
    std::vector<CaseRecord> out;
    for (SweepCase const& c : manifest.cases)
        if (auto const at = messages.find(c.id); at != messages.end() && done.count(c.id) == 0)
            out.push_back({c.id, false, at->second});
    return out;
}

} // namespace tessemu
