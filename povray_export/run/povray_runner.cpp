// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/povray_runner.h"

#include "base/files.h"
#include "povray_export/run/child_process.h"
#include "povray_export/run/live_picture.h"
#include "povray_export/run/pixel_spreading.h"
#include "povray_export/run/povray_messages.h"
#include "povray_export/run/state_file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <optional>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace lodestone::povray {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds between two looks at memory and the job.
/// Taste: a larger value misses peaks of memory and is slower to cancel.
constexpr int kTickMs = 20;
/// Seconds between asking POV-Ray to stop and stopping it.
/// Taste: a larger value waits longer for POV-Ray to save and clean up.
constexpr double kGraceS = 0.5;
/// How POV-Ray asks the system for memory: in steps of 16 MB and pages of 2 MB, for all threads
/// together. Parsing asks for pieces hundreds of times a millisecond, tracing once in some pixels.
/// Taste: smaller steps and pages keep less for what is never asked, and are slower to get.
constexpr const char* kMallocTunables =
    "glibc.malloc.hugetlb=1:glibc.malloc.arena_max=1:glibc.malloc.top_pad=16777216";
/// The share of the progress bar for parsing.
/// Taste: a larger value makes the bar jump in scenes that are parsed at once.
constexpr double kParsePart = 0.15;
/// The side in pixels of the first squares of a mosaic.
/// Law: POV-Ray's blocks; larger squares would not come sooner.
constexpr int kFirstSquare = 32;
/// The side in pixels of its last squares.
/// Taste: a smaller value looks finer and costs more: 8 is one pixel in 64, 4 one in 16.
constexpr int kLastSquare = 8;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string reason(int number) {
    char buffer[256];
    return strerror_r(number, buffer, sizeof buffer);
}

bool is_program(const std::string& path) {
    struct stat info {};
    return stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) &&
           access(path.c_str(), X_OK) == 0;
}

/// The running process. Its end is certain, with the output closed and the process reaped, whatever
/// happens. It is made, watched and destroyed on one thread: POV-Ray is killed when that thread
/// ends.
class PovrayProcess {
public:
    PovrayProcess(const std::string& program, const std::filesystem::path& folder,
                  const std::vector<std::string>& arguments) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
            fail(Status::Io, "cannot make a pipe for POV-Ray: ", reason(errno));
        output_ = ends[0];
        fcntl(output_, F_SETFL, O_NONBLOCK);

        std::vector<std::string> environment = {"LC_ALL=C"};
        const std::pair<const char*, const char*> names_and_defaults[] = {
            {"PATH", nullptr}, {"HOME", nullptr}, {"GLIBC_TUNABLES", kMallocTunables}};
        for (const auto& [name, otherwise] : names_and_defaults) {
            const char* own = std::getenv(name);
            const char* value = own != nullptr ? own : otherwise;
            if (value != nullptr)
                environment.push_back(text(name, '=', value));
        }
        try {
            process_ = spawn({program, arguments, environment, folder, ends[1]});
        } catch (...) {
            close(ends[1]);
            close(output_);
            throw;
        }
        close(ends[1]);
    }

    ~PovrayProcess() {
        stop();
        close(output_);
    }
    PovrayProcess(const PovrayProcess&) = delete;
    PovrayProcess& operator=(const PovrayProcess&) = delete;

    /// Waits a tick for text; false once there can be no more.
    void wait_for_text(PovrayMessages& messages) const {
        pollfd waiting{output_, POLLIN, 0};
        poll(&waiting, 1, kTickMs);
        // After the other end was closed poll returns at once: do not spin until the process ends.
        if ((waiting.revents & POLLIN) == 0 && (waiting.revents & POLLHUP) != 0)
            usleep(1000);
        read_text(messages);
    }

    void read_text(PovrayMessages& messages) const {
        char buffer[16384];
        for (int i = 0; i < 64; ++i) {  // a flood of text must not keep us from the job
            const ssize_t got = read(output_, buffer, sizeof buffer);
            if (got <= 0)
                return;
            messages.read({buffer, static_cast<size_t>(got)});
        }
    }

    /// True once the process has ended; then `state` is waitpid's.
    bool ended() {
        if (process_ < 0)
            return true;
        const pid_t got = waitpid(process_, &state, WNOHANG);
        // The host may let the system reap its children: then only the output tells how it went.
        if (got < 0 && errno == ECHILD)
            state_lost = true;
        if (got == process_ || state_lost)
            process_ = -1;
        return process_ < 0;
    }

    /// The largest memory so far in bytes, or 0 when it is not known any more.
    uint64_t peak_bytes() const {
        if (process_ < 0)
            return 0;
        char name[40] = "/proc/";
        char* end = std::to_chars(name + 6, name + 30, process_).ptr;
        std::memcpy(end, "/status", 8);
        const int file = open(name, O_RDONLY | O_CLOEXEC);
        if (file < 0)
            return 0;
        char buffer[4096];
        const ssize_t got = read(file, buffer, sizeof buffer - 1);
        close(file);
        buffer[std::max<ssize_t>(got, 0)] = '\0';
        const char* at = std::strstr(buffer, "VmHWM:");
        return at == nullptr ? 0 : std::strtoull(at + 6, nullptr, 10) * 1024;
    }

    void stop() {
        if (ended())
            return;
        const pid_t group = process_;
        kill(-group, SIGTERM);
        const Clock::time_point asked = Clock::now();
        PovrayMessages unheard;
        while (seconds_since(asked) < kGraceS) {
            read_text(unheard);  // or it would wait for us with a full pipe
            if (ended()) {
                kill(-group, SIGKILL);  // a wrapper script may have left others
                return;
            }
            usleep(5000);
        }
        kill(-group, SIGKILL);
        while (waitpid(process_, &state, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
    }

    int state = 0;
    bool state_lost = false;

private:
    pid_t process_ = -1;
    int output_ = -1;
};

/// The names of one run inside the folder; files left under them when it ends are removed.
struct TemporaryPicture {
    explicit TemporaryPicture(const std::filesystem::path& folder, const char* extension) {
        static std::atomic<uint32_t> counter{0};
        const std::string stem = text("part-", getpid(), "-", counter++);
        name = stem + extension;
        picture = folder / name;
        state = folder / (stem + ".pov-state");
    }
    ~TemporaryPicture() {
        unlink(picture.c_str());
        unlink(state.c_str());
    }
    TemporaryPicture(const TemporaryPicture&) = delete;
    TemporaryPicture& operator=(const TemporaryPicture&) = delete;

    std::string name;
    std::filesystem::path picture;
    std::filesystem::path state;
};

const char* extension_of(OutputFormat output) {
    switch (output) {
        case OutputFormat::Exr:
            return ".exr";
        case OutputFormat::Png:
            return ".png";
        case OutputFormat::Ppm:
            break;
    }
    return ".ppm";
}

std::vector<std::string> arguments_of(const RunOptions& options, const std::string& program,
                                      const std::string& output_name) {
    std::vector<std::string> out = {program, "scene.ini", "+O" + output_name, "-D", "+V",
                                    "-P",    "-C"};
    switch (options.output) {
        case OutputFormat::Exr:
            out.emplace_back("+FE");
            break;
        case OutputFormat::Png:
            out.emplace_back("+FN8");
            break;
        case OutputFormat::Ppm:
            out.emplace_back("+FP16");
            out.emplace_back("File_Gamma=1");
            break;
    }
    if (options.width > 0)
        out.push_back(text("+W", options.width));
    if (options.height > 0)
        out.push_back(text("+H", options.height));
    if (options.threads > 0)
        out.push_back(text("+WT", options.threads));
    if (options.mosaic) {
        out.push_back(text("+SP", kFirstSquare));
        out.push_back(text("+EP", kLastSquare));
    }
    return out;
}

/// The likely reason why a signal ended POV-Ray: the object that the scene names for its clear
/// surfaces.
std::string likely_reason(const std::filesystem::path& folder, int signal) {
    if (signal == SIGKILL)
        return "; the system does that when memory is short";
    // Law: what a stack that is too small ends by.
    if (signal != SIGSEGV && signal != SIGBUS)
        return "";
    std::ifstream scene(folder / "scene.pov");
    std::string line;
    while (std::getline(scene, line)) {
        if (line.starts_with("#include"))
            break;
        if (!line.starts_with(kClearObject))
            continue;
        const std::string rest = line.substr(std::strlen(kClearObject));
        const size_t space = rest.find(' ');
        if (space == std::string::npos)
            break;
        return text("; it does not bear many clear surfaces one behind the other, and '",
                    rest.substr(space + 1), "' has about ", rest.substr(0, space));
    }
    return "";
}

/// `live`: the picture that is drawn into; null: only messages tell how far it is.
void show_progress(const PovrayMessages& messages, const LivePicture* live, const Job& job) {
    if (messages.pixels == 0) {
        // The number of tokens to parse is not known: half of this part is a million of them.
        const auto tokens = static_cast<double>(messages.parsed_tokens);
        job.progress(kParsePart * tokens / (tokens + 1e6));
        return;
    }
    job.stage(JobStage::Trace);
    // The messages count the pixels of every step of a mosaic from 0 again.
    const uint64_t done = live != nullptr ? live->finished() : messages.pixels_done;
    const uint64_t pixels = live != nullptr ? live->pixels() : messages.pixels;
    const double part = static_cast<double>(done) / static_cast<double>(pixels);
    job.progress(kParsePart + (1 - kParsePart) * part);
}

}  // namespace

std::string find_program(const std::string& program) {
    std::string wanted = program;
    const char* set = std::getenv("LODESTONE_POVRAY");
    const bool from_environment = wanted.empty() && set != nullptr && *set != '\0';
    if (from_environment)
        wanted = set;
    if (wanted.empty())
        wanted = "povray";
    if (wanted.find('/') != std::string::npos) {
        // The program starts in another folder.
        std::error_code error;
        std::string absolute = std::filesystem::absolute(wanted, error).string();
        if (!error && is_program(absolute))
            return absolute;
        fail(Status::PovrayMissing, "'", wanted, "' is not a program",
             from_environment ? " (it is what LODESTONE_POVRAY is set to)" : "",
             "; POV-Ray 3.7 is in Debian's package povray");
    }
    const char* path = std::getenv("PATH");
    const std::string places = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
    for (size_t begin = 0; begin <= places.size();) {
        const size_t end = std::min(places.find(':', begin), places.size());
        std::string candidate = places.substr(begin, end - begin) + '/' + wanted;
        if (candidate.front() == '/' && end > begin && is_program(candidate))
            return candidate;
        begin = end + 1;
    }
    fail(Status::PovrayMissing, "POV-Ray ('", wanted,
         "') was not found on the PATH; install Debian's package povray, or set LODESTONE_POVRAY "
         "to the program");
}

RunReport render_scene(const RunOptions& options, const Job& job) {
    const char* extension = extension_of(options.output);
    const std::string name =
        options.output_name.empty() ? std::string("picture") + extension : options.output_name;
    if (!safe_relative_name(name) || name.find('/') != std::string::npos)
        fail(Status::InvalidArgument, "'", name,
             "' cannot be the name of a picture: letters, digits, '.', '_' and '-' only");
    std::error_code error;
    if (!std::filesystem::is_regular_file(options.folder / "scene.ini", error))
        fail(Status::Io, "there is no exported scene in '", options.folder.string(), "'");
    const std::string program = find_program(options.program);
    job.check();
    job.stage(JobStage::Parse);

    const Clock::time_point start = Clock::now();
    const TemporaryPicture temporary(options.folder, extension);
    std::optional<StateFile> drawn;
    if (options.live != nullptr)
        drawn.emplace(temporary.state, *options.live);
    PovrayMessages messages;
    RunReport report;
    PovrayProcess child(program, options.folder, arguments_of(options, program, temporary.name));
    do {
        if (job.cancelled()) {
            child.stop();
            if (drawn)
                drawn->read_rest();
            job.check();
        }
        report.peak_bytes = std::max(report.peak_bytes, child.peak_bytes());
        child.wait_for_text(messages);
        if (drawn)
            drawn->read_some();
        show_progress(messages, drawn && !drawn->broken() ? options.live : nullptr, job);
    } while (!child.ended());
    if (drawn)
        drawn->read_rest();
    child.read_text(messages);
    messages.finish();
    report.wall_s = seconds_since(start);
    report.messages = messages.text();
    report.parse_cpu_s = messages.parse_cpu_s;
    report.trace_cpu_s = messages.trace_cpu_s;

    if (!child.state_lost && WIFSIGNALED(child.state)) {
        const int signal = WTERMSIG(child.state);
        const char* word = sigabbrev_np(signal);  // real-time signals have none
        fail(Status::PovrayFailed, "POV-Ray was ended by signal ", signal, " (",
             word != nullptr ? word : "no name", likely_reason(options.folder, signal), ")");
    }
    report.exit_code = child.state_lost ? (messages.finished ? 0 : 1) : WEXITSTATUS(child.state);
    if (report.exit_code != 0)
        fail(Status::PovrayFailed, "POV-Ray failed (",
             child.state_lost ? "another part of this program took its exit code"
                              : text("exit code ", report.exit_code),
             "): ", messages.reason());
    if (options.spread > 0 && std::filesystem::exists(temporary.picture, error))
        spread_picture(temporary.picture, options.output, options.spread,
                       options.folder / "scene.ini");
    report.picture = options.folder / name;
    if (rename(temporary.picture.c_str(), report.picture.c_str()) != 0) {
        const int number = errno;
        if (number == ENOENT)
            fail(Status::PovrayFailed, "'", program,
                 "' ended without a picture: ", messages.reason());
        fail(Status::Io, "cannot write '", report.picture.string(), "': ", reason(number));
    }
    job.progress(1);
    return report;
}

}  // namespace lodestone::povray
