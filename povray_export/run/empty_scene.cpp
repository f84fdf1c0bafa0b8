// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/empty_scene.h"

#include <cerrno>
#include <cstdlib>
#include <map>
#include <mutex>
#include <tuple>

namespace lodestone::povray {
namespace {

/// A folder of our own, which is removed with its content when it is no longer needed.
struct TemporaryFolder {
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "lodestone-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            fail(Status::Io, "cannot make a folder like '", name, "'");
        path = name;
    }
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path, error);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path path;
};

}  // namespace

uint64_t empty_scene_bytes(const View& view, Antialiasing antialiasing, const RunOptions& like,
                           const Job& job) {
    using Key = std::tuple<std::string, int, int, int, OutputFormat, Antialiasing>;
    static std::mutex mutex;
    static std::map<Key, uint64_t> known;
    const int width = like.width > 0 ? like.width : view.width;
    const int height = like.height > 0 ? like.height : view.height;
    const Key key{
        find_program(like.program), width, height, like.threads, like.output, antialiasing};
    {
        const std::lock_guard lock(mutex);
        const auto at = known.find(key);
        if (at != known.end())
            return at->second;
    }
    const TemporaryFolder folder;
    ExportOptions scene;
    scene.folder = folder.path;
    scene.antialiasing = antialiasing;
    Problems problems;
    export_scene(Model{}, choose::Cut{}, view, scene, problems, job.part(0, 0));
    RunOptions options = like;
    options.folder = folder.path;
    const uint64_t bytes = render_scene(options, job).peak_bytes;
    const std::lock_guard lock(mutex);
    return known[key] = bytes;
}

}  // namespace lodestone::povray
