// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray runner: starts POV-Ray on an exported scene, watches it, and stops it when asked.
#pragma once

#include "base/job.h"

#include <filesystem>
#include <string>

namespace lodestone::povray {

class LivePicture;

/// The format of the picture.
enum class OutputFormat : uint8_t {
    Exr = 0,  // linear, values above 1 kept
    Png = 1,  // 8 bits, sRGB
    Ppm = 2,  // 16 bits, linear: for programs without libraries
};

/// A scene and how it is rendered.
struct RunOptions {
    std::filesystem::path folder = {};  // the folder of export_scene()
    std::string program = {};  // "": the environment's LODESTONE_POVRAY, else povray on the PATH
    int width = 0;             // 0: as exported
    int height = 0;
    int threads = 0;  // 0: all threads
    OutputFormat output = OutputFormat::Exr;
    std::string output_name = {};  // plain ASCII, in the folder; "": picture.exr, .png or .ppm
    // The variance, in square pixels, by which the finished picture is blurred: what a pixel filter
    // spreads more than samples within a pixel do (image::missing_spread()). 0: as drawn
    double spread = 0;
    // A picture for somebody who looks while it is drawn; its part is what the scene's settings
    // draw. null: nobody looks.
    LivePicture* live = nullptr;
    // true: a mosaic is drawn first, for somebody who looks. It leaves the picture as it is, but for what lies
    // outside a border, and but for gathered light, of which it gathers more.
    bool mosaic = false;
};

/// The result of a run.
struct RunReport {
    int exit_code = 0;
    double parse_cpu_s = 0;  // parsing and bounding, by POV-Ray's own statistics
    double trace_cpu_s = 0;  // sum over all threads
    double wall_s = 0;
    uint64_t peak_bytes = 0;  // VmHWM, sampled every 20 ms
    std::string messages;     // the last 8 KB of POV-Ray's warnings and errors
    std::filesystem::path picture;
};

/// The beginning of the line of a scene that names the object with the most clear surfaces one
/// behind the other: their number and its name follow.
inline constexpr const char* kClearObject = "// Clear layers: ";

/// The program that render_scene() would start. Throws Error(PovrayMissing) that says what to
/// install or set.
std::string find_program(const std::string& program = "");

/// Renders folder/scene.ini; stages Parse and Trace. The picture appears under its name when it is
/// complete, and an old one stays until then. Throws Error(PovrayMissing); Error(PovrayFailed) with
/// POV-Ray's own sentence; Error(Cancelled), at most 1 s after the job was cancelled. However it
/// ends, no process and no file of a broken run is left; killing this process kills POV-Ray, too.
/// It may be called from any thread, several times at once.
RunReport render_scene(const RunOptions& options, const Job& job = {});

}  // namespace lodestone::povray
