// SPDX-License-Identifier: Apache-2.0
#include "cli/process.h"

#include "cli/run_output.h"
#include "emu/error.h"

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tessemu {

namespace {

bool is_ignored(int signal)
{
    struct sigaction now = {};
    return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

void end_by_signal(sigset_t ending)
{
    int signal = 0;
    if (sigwait(&ending, &signal) != 0) return;
    remove_temporaries();
    std::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
    kill(getpid(), signal);
    for (;;) pause();
}

} // namespace

void set_up_process()
{
    for (int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(fd, F_GETFD) < 0) // open takes the lowest number that is free
            static_cast<void>(open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY));

    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);

    sigset_t ending;
    sigemptyset(&ending);
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(signal)) sigaddset(&ending, signal); // nohup's, and a shell's with &
    pthread_sigmask(SIG_BLOCK, &ending, nullptr);
    try {
        std::thread(end_by_signal, ending).detach();
    } catch (std::system_error const&) { // no thread to be had: they end the process at once
        pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
    }
}

bool close_standard_output()
{
    if (close(STDOUT_FILENO) == 0 || errno == EBADF) return true;
    print_message("tessemu: standard output: " + std::generic_category().message(errno) + "\n");
    return false;
}

std::string run_program(std::vector<std::string> const& words)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error(std::generic_category().message(errno));
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
    // As it would be without us: set_up_process() blocks and ignores some signals.
    posix_spawnattr_t as_usual;
    posix_spawnattr_init(&as_usual);
    sigset_t none, ignored;
    sigemptyset(&none);
    sigemptyset(&ignored);
    sigaddset(&ignored, SIGPIPE);
    sigaddset(&ignored, SIGXFSZ);
    posix_spawnattr_setsigmask(&as_usual, &none);
    posix_spawnattr_setsigdefault(&as_usual, &ignored);
    posix_spawnattr_setflags(&as_usual, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> arguments;
    for (std::string const& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
    arguments.push_back(nullptr);
    pid_t child = 0;
    int const error =
        posix_spawnp(&child, arguments[0], &files, &as_usual, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&as_usual);
    close(ends[1]);
    std::string out;
    char buffer[4096];
    for (ssize_t n = 0; error == 0 && (n = read(ends[0], buffer, sizeof buffer)) != 0;)
        if (n > 0)
            out.append(buffer, std::size_t(n));
        else if (errno != EINTR)
            break;
    close(ends[0]);
    if (error != 0) throw Error(words[0] + ": " + std::generic_category().message(error));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(WIFEXITED(status)
                        ? words[0] + " ended with status " + std::to_string(WEXITSTATUS(status))
                        : words[0] + " was ended by signal " + std::to_string(WTERMSIG(status)));
    return out;
}

std::string own_path()
{
    return std::filesystem::read_symlink("/proc/self/exe").string();
}

} // namespace tessemu
