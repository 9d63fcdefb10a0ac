// SPDX-License-Identifier: Apache-2.0
#include "sweep/claims.h"

#include "io/output_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <charconv>
#include <condition_variable>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tessemu {

namespace fs = std::filesystem;

namespace {

std::string first_line(fs::path const& path)
{
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    return line;
}

// When a process began, in ticks since the system's start: numbers of processes come again. Empty:
// there is none, or it has ended and nobody has asked how.
std::string start_of(long pid)
{
    std::string const stat = first_line(fmt::format("/proc/{}/stat", pid));
    std::size_t at = stat.rfind(')'); // a name may hold anything
    if (at != std::string::npos && (stat.substr(at, 3) == ") Z" || stat.substr(at, 3) == ") X"))
        return "";
    for (int field = 2; field < 22 && at != std::string::npos; ++field) at = stat.find(' ', at + 1);
    return at == std::string::npos ? "" : stat.substr(at + 1, stat.find(' ', at + 1) - at - 1);
}

struct Process {
    std::string host, system, start; ///< system: this boot, and the namespace of its processes
    long pid = 0;

    static Process own()
    {
        char name[256] = {};
        gethostname(name, sizeof name - 1);
        std::error_code none;
        std::string const processes = fs::read_symlink("/proc/self/ns/pid", none).string();
        return {name, first_line("/proc/sys/kernel/random/boot_id") + processes, start_of(getpid()),
                getpid()};
    }
    std::string json() const
    {
        return nlohmann::ordered_json{
            {"host", host}, {"system", system}, {"process", pid}, {"start", start}}
            .dump();
    }
    static std::optional<Process> parse(std::string const& text)
    {
        auto const j = nlohmann::json::parse(text, nullptr, false);
        try {
            return Process{j.at("host"), j.at("system"), j.at("start"), j.at("process")};
        } catch (nlohmann::json::exception const&) {
            return {}; // made and not yet written
        }
    }
    bool is_alive() const
    {
        return (kill(pid_t(pid), 0) == 0 || errno == EPERM) && start_of(pid) == start;
    }
};

[[noreturn]] void fail(fs::path const& path, int error)
{
    throw WriteError(path.string() + ": " + std::generic_category().message(error));
}

double seconds_of(timespec t)
{
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

} // namespace

struct Claims::Impl {
    struct Claim {
        int generation = 0;
        fs::path path;
        std::optional<Process> process;
        double touched = 0; ///< by the file server's clock
    };

    fs::path folder;
    double lease;
    Process self = Process::own();
    mutable std::mutex mutex;
    std::map<std::size_t, int> own; // generation by block
    std::condition_variable ended;
    bool ends = false;
    std::thread toucher;

    fs::path path_of(std::size_t block, int generation) const
    {
        return folder / fmt::format("{:06}.{}", block, generation);
    }

    // The last first: nobody looks at those before it, and the first bars the block.
    void remove(std::size_t block, int last) const
    {
        for (int g = last; g >= 0; --g) unlink(path_of(block, g).c_str());
    }

    void touch_all()
    {
        std::unique_lock lock(mutex);
        auto const quarter = std::chrono::duration<double>(lease / 4);
        while (!ended.wait_for(lock, quarter, [&] { return ends; }))
            for (auto const& [block, generation] : own)
                utimensat(AT_FDCWD, path_of(block, generation).c_str(), nullptr, 0);
    }

    // The highest generation's.
    std::optional<Claim> latest(std::size_t block) const
    {
        std::optional<Claim> out;
        std::string const prefix = fmt::format("{:06}.", block);
        std::error_code none;
        for (fs::directory_entry const& e : fs::directory_iterator(folder, none)) {
            std::string const name = e.path().filename().string();
            if (!name.starts_with(prefix)) continue;
            int generation = 0;
            std::from_chars(name.data() + prefix.size(), name.data() + name.size(), generation);
            if (!out || generation > out->generation) out = Claim{generation, e.path(), {}, 0};
        }
        return out ? read(out->generation, out->path) : out;
    }

    // None: given back meanwhile.
    static std::optional<Claim> read(int generation, fs::path const& path)
    {
        struct stat status = {};
        if (stat(path.c_str(), &status) != 0) return {};
        return Claim{generation, path, Process::parse(first_line(path)),
                     seconds_of(status.st_mtim)};
    }

    fs::path own_file(char const* what) const
    {
        return folder / fmt::format("{}-{}-{}", what, self.host, self.pid);
    }

    // The file server's clock is the one that touches are told by.
    double now() const
    {
        fs::path const probe = own_file("clock");
        int const file = open(probe.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0666);
        if (file < 0) fail(probe, errno);
        struct stat status = {};
        utimensat(AT_FDCWD, probe.c_str(), nullptr, 0);
        fstat(file, &status);
        close(file);
        unlink(probe.c_str());
        return seconds_of(status.st_mtim);
    }

    bool is_own(Claim const& c) const
    {
        return c.process && c.process->system == self.system && c.process->pid == self.pid &&
               c.process->start == self.start;
    }

    bool has_lapsed(Claim const& c) const
    {
        if (c.process && c.process->system == self.system) return !c.process->is_alive();
        return now() - c.touched > lease;
    }

    // False: there is such a claim already. It says whose it is from its first moment on: it is written
    // under another name, which is linked to its own.
    bool make(std::size_t block, int generation)
    {
        fs::path const path = path_of(block, generation), fresh = own_file("new");
        std::string const text = self.json() + "\n";
        // Without a name where the file system can: then a process that is killed leaves nothing.
        int file = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
        bool const is_named = file < 0;
        if (is_named) file = open(fresh.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
        if (file < 0) fail(fresh, errno);
        bool const written = write(file, text.data(), text.size()) == ssize_t(text.size());
        int error = written ? 0 : errno;
        bool made = false;
        if (written) {
            std::string const from =
                is_named ? fresh.string() : fmt::format("/proc/self/fd/{}", file);
            made = linkat(AT_FDCWD, from.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
            error = made ? 0 : errno;
        }
        close(file);
        if (is_named) unlink(fresh.c_str());
        if (error == EEXIST) return false;
        if (written && !made && (error == EPERM || error == EOPNOTSUPP || error == ENOSYS))
            made = make_without_links(path, text, error);
        if (!made && error == EEXIST) return false;
        if (!made) fail(path, error);
        own[block] = generation;
        return true;
    }

    // On file systems that have no hard links.
    static bool make_without_links(fs::path const& path, std::string const& text, int& error)
    {
        int const file = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        error = errno;
        if (file < 0) return false;
        bool const written = write(file, text.data(), text.size()) == ssize_t(text.size());
        error = errno;
        close(file);
        if (!written) unlink(path.c_str());
        return written;
    }
};

Claims::Claims(fs::path folder, double lease_seconds) : impl_(std::make_unique<Impl>())
{
    impl_->folder = std::move(folder);
    impl_->lease = lease_seconds;
    impl_->toucher = std::thread([this] { impl_->touch_all(); });
}

Claims::~Claims()
{
    {
        std::scoped_lock const lock(impl_->mutex);
        impl_->ends = true;
    }
    impl_->ended.notify_all();
    impl_->toucher.join();
    std::vector<std::size_t> left;
    for (auto const& [block, generation] : impl_->own) left.push_back(block);
    give_back(left);
}

bool Claims::take(std::size_t block)
{
    std::scoped_lock const lock(impl_->mutex);
    if (impl_->own.count(block)) return false; // another thread's
    std::optional<Impl::Claim> const held = impl_->latest(block);
    if (held && !impl_->has_lapsed(*held)) return false;
    int const generation = held ? held->generation + 1 : 0;
    if (!impl_->make(block, generation)) return false;
    // What was seen may be gone by now: taken over, done, given back, and claimed by another.
    auto const now = impl_->latest(block);
    bool good = now && now->generation == generation;
    if (held) {
        auto const before = impl_->read(held->generation, held->path);
        good = good && before && impl_->has_lapsed(*before);
    }
    if (good) return true;
    unlink(impl_->path_of(block, generation).c_str());
    impl_->own.erase(block);
    return false;
}

void Claims::give_back(std::vector<std::size_t> const& blocks)
{
    std::scoped_lock const lock(impl_->mutex);
    for (std::size_t const block : blocks) {
        auto const at = impl_->own.find(block);
        if (at == impl_->own.end()) continue;
        // Of a block that another took over meanwhile nothing: the first generation is what bars it.
        auto const held = impl_->latest(block);
        if (held && held->generation == at->second && impl_->is_own(*held))
            impl_->remove(block, held->generation);
        impl_->own.erase(at);
    }
}

void Claims::clear_lapsed(std::function<bool(std::size_t block)> const& is_done)
{
    std::scoped_lock const lock(impl_->mutex);
    std::vector<std::size_t> blocks;
    std::error_code none;
    for (fs::directory_entry const& e : fs::directory_iterator(impl_->folder, none)) {
        std::string const name = e.path().filename().string();
        std::size_t block = 0;
        auto const [end, error] = std::from_chars(name.data(), name.data() + name.size(), block);
        if (error == std::errc() && *end == '.' && is_done(block)) blocks.push_back(block);
    }
    for (std::size_t const block : blocks)
        if (auto const held = impl_->latest(block); held && impl_->has_lapsed(*held))
            impl_->remove(block, held->generation);
    // What a process that was killed while it made a claim has left.
    for (fs::directory_entry const& e : fs::directory_iterator(impl_->folder, none)) {
        std::string const name = e.path().filename().string();
        struct stat status = {};
        if ((name.starts_with("new-") || name.starts_with("clock-")) &&
            stat(e.path().c_str(), &status) == 0 &&
            impl_->has_lapsed(
                {0, e.path(), Process::parse(first_line(e.path())), seconds_of(status.st_mtim)}))
            unlink(e.path().c_str());
    }
}

std::string Claims::holder(std::size_t block) const
{
    auto const held = impl_->latest(block);
    if (!held || !held->process) return "somebody";
    return fmt::format("{}, process {}", held->process->host, held->process->pid);
}

} // namespace tessemu
