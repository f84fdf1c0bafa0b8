// SPDX-License-Identifier: GPL-3.0-or-later
// Guards running POV-Ray: its sentence when it fails, stopping it, and nothing left behind.
#include "image/image.h"
#include "povray/povray_scenes.h"
#include "povray_export/run/empty_scene.h"
#include "povray_export/run/live_picture.h"
#include "povray_export/run/povray_messages.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// Says what the last run threw.
template <typename Body>
Error error_of(const Body& body) {
    try {
        body();
    } catch (const Error& error) {
        return error;
    }
    return {Status::Ok, "no error"};
}

bool says(const Error& error, const std::string& part) {
    return std::string(error.what()).find(part) != std::string::npos;
}

std::filesystem::path scene_with(const std::string& name, const std::string& pov,
                                 const std::string& size = "Width=32\nHeight=32\n") {
    auto folder = scratch(name);
    std::filesystem::create_directories(folder / "r");
    std::ofstream(folder / "scene.pov") << "#version 3.7;\n" << pov;
    std::ofstream(folder / "scene.ini") << "Input_File_Name=scene.pov\n" << size;
    return folder;
}

/// A program that says and does what it is told, instead of POV-Ray.
std::string script(const std::filesystem::path& folder, const std::string& body) {
    const auto path = folder / "program.sh";
    std::ofstream(path) << "#!/bin/sh\n" << body;
    chmod(path.c_str(), 0755);
    return path.string();
}

size_t files_in(const std::filesystem::path& folder) {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        count += entry.is_regular_file() ? 1 : 0;
    return count;
}

/// True once a process is gone, or a zombie that waits for init; the system takes a moment.
bool gone(int process, int tries) {
    for (int i = 0; i < tries; ++i) {
        std::ifstream file(text("/proc/", process, "/stat"));
        std::string stat;  // number (name) state ...; of one that is loading a program, too
        if (!std::getline(file, stat))
            return true;
        const size_t state = stat.rfind(')') + 2;
        if (state < stat.size() && (stat[state] == 'Z' || stat[state] == 'X'))
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// A line of a file, "" while it has none.
std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line;
    return std::getline(file, line) && !file.eof() ? line : "";
}

const char* const kSphere =
    "global_settings{assumed_gamma 1} camera{location <0,0,-3>} sphere{0,1 pigment{rgb 1} "
    "finish{ambient 1}}\n";
// Hours of work.
const char* const kSlow =
    "camera{location <0,0,-3>} light_source{-5 rgb 1 area_light x,y,12,12}\n"
    "sphere{0,1 pigment{rgbt .5} finish{reflection .5}} plane{z,1 pigment{rgb 1}}\n";

}  // namespace

TEST(PovrayRunner, MessagesAreTakenApartHoweverTheyArrive) {
    const std::string said =
        "povray: cannot open the user configuration file /x: No such file or directory\n"
        "==== [Parsing...] ====\rParsing 7295K tokens\r"
        "File 'e.pov' line 4: Possible Parse Error: Cannot find file 'r/none.inc', even\n"
        " after trying to append file type extension.\n"
        "File 'e.pov' line 4: Parse Error: Cannot open include file r/none.inc.\n"
        "Fatal error in parser: Cannot parse input.\n"
        "  Parse Time:       0 hours  0 minutes  2 seconds (2.000 seconds)\n"
        "              using 1 thread(s) with 1.750 CPU-seconds total\n"
        "  Bounding Time:    0 hours  0 minutes  0 seconds (0.000 seconds)\n"
        "              using 1 thread(s) with 0.250 CPU-seconds total\n"
        "Rendered 1024 of 2304 pixels (44%)\rRendered 2048 of 2304 pixels (88%)\r"
        "  Trace Time:       0 hours  0 minutes  1 seconds (1.000 seconds)\n"
        "              using 2 thread(s) with 3.500 CPU-seconds total\nRender failed";
    for (const size_t step : {said.size(), size_t{1}, size_t{7}}) {
        PovrayMessages messages;
        for (size_t at = 0; at < said.size(); at += step)
            messages.read(std::string_view(said).substr(at, step));
        messages.finish();
        EXPECT_EQ(messages.parsed_tokens, 7295000u);
        EXPECT_EQ(messages.pixels_done, 2048u);
        EXPECT_EQ(messages.pixels, 2304u);
        EXPECT_DOUBLE_EQ(messages.parse_cpu_s, 2);
        EXPECT_DOUBLE_EQ(messages.trace_cpu_s, 3.5);
        EXPECT_EQ(messages.reason(),
                  "File 'e.pov' line 4: Parse Error: Cannot open include file r/none.inc.");
        EXPECT_NE(messages.text().find("even after trying"), std::string::npos);
        EXPECT_EQ(messages.text().find("configuration"), std::string::npos);
    }
    PovrayMessages flood;
    for (int i = 0; i < 2000; ++i)
        flood.read("File 'x' line 1: Parse Warning: Normal vector in mesh2 cannot be zero\n");
    flood.finish();
    EXPECT_LE(flood.text().size(), 8192u);
    EXPECT_GE(flood.text().size(), 8000u);
}

TEST(PovrayRunner, AMissingProgramSaysWhatToInstallOrSet) {
    const auto folder = scene_with("missing", kSphere);
    const Error error =
        error_of([&] { render_scene({.folder = folder, .program = "no-such-povray"}); });
    EXPECT_EQ(error.status, Status::PovrayMissing);
    EXPECT_TRUE(says(error, "no-such-povray"));
    EXPECT_TRUE(says(error, "install"));
    EXPECT_TRUE(says(error, "LODESTONE_POVRAY"));
    EXPECT_EQ(
        error_of([&] { render_scene({.folder = folder, .program = folder.string()}); }).status,
        Status::PovrayMissing);

    const char* before = std::getenv("LODESTONE_POVRAY");
    const std::string kept = before != nullptr ? before : "";
    setenv("LODESTONE_POVRAY", "/nowhere/povray", 1);
    const Error set = error_of([&] { render_scene({.folder = folder}); });
    if (before != nullptr)
        setenv("LODESTONE_POVRAY", kept.c_str(), 1);
    else
        unsetenv("LODESTONE_POVRAY");
    EXPECT_EQ(set.status, Status::PovrayMissing);
    EXPECT_TRUE(says(set, "'/nowhere/povray'"));
    EXPECT_TRUE(says(set, "LODESTONE_POVRAY"));
}

TEST(PovrayRunner, CallersMistakesAreNamed) {
    const auto folder = scene_with("mistakes", kSphere);
    for (const char* name : {"../x.png", "a b.png", "/x.png", "r/x.png", "x;y.png"}) {
        const Error error =
            error_of([&] { render_scene({.folder = folder, .output_name = name}); });
        EXPECT_EQ(error.status, Status::InvalidArgument) << name;
        EXPECT_TRUE(says(error, name));
    }
    EXPECT_EQ(error_of([&] { render_scene({.folder = folder / "nowhere"}); }).status, Status::Io);
}

TEST(PovrayRunner, AProgramThatDiesOrMakesNoPictureIsAFailure) {
    const auto folder = scene_with("strange", kSphere);
    std::ofstream(folder / "picture.exr") << "old";
    const auto with = [&](const std::string& body) {
        const std::string program = script(folder, body);
        return error_of([&] { render_scene({.folder = folder, .program = program}); });
    };
    EXPECT_EQ(with("exit 0\n").status, Status::PovrayFailed);
    EXPECT_TRUE(says(with("exit 0\n"), "without a picture"));
    EXPECT_TRUE(says(with("kill -KILL $$\n"), "signal 9 (KILL"));
    EXPECT_TRUE(says(with("kill -40 $$\n"), "signal 40 (no name)"));
    // Only a stack that is too small is what clear surfaces do.
    std::ofstream(folder / "scene.pov") << kClearObject << "200 bush\n";
    EXPECT_TRUE(says(with("kill -SEGV $$\n"), "'bush' has about 200"));
    EXPECT_FALSE(says(with("kill -TERM $$\n"), "bush"));
    EXPECT_FALSE(says(with("kill -FPE $$\n"), "bush"));
    EXPECT_TRUE(says(with("echo 'Parse Error: of mine' >&2; exit 1\n"), "of mine"));
    EXPECT_TRUE(says(with("echo 'Parse Error: of mine' >&2; exit 1\n"), "exit code 1"));
    EXPECT_TRUE(says(with("exit 7\n"), "(exit code 7): it said nothing"));
    EXPECT_TRUE(says(with("echo so; echo; exit 7\n"), "its last line: so"));
    EXPECT_EQ(with("yes | head -c 3000000; exit 1\n").status, Status::PovrayFailed);
    EXPECT_EQ(read_file(folder / "picture.exr"), "old");
    EXPECT_EQ(files_in(folder), 4u);  // scene.pov, scene.ini, program.sh, the old picture
}

TEST(PovrayRunner, TheChildGetsACleanEnvironmentAndNoFilesOfOurs) {
    const auto folder = scene_with("clean", kSphere);
    setenv("LODESTONE_TEST_LEAK", "1", 1);
    const std::string program =
        script(folder, "env > env.txt; ls /proc/$$/fd > fd.txt; trap > trap.txt; exit 1\n");
    const int leak = open("/dev/null", 0);  // not close-on-exec, as a host program's may be
    ASSERT_GE(leak, 3);
    std::signal(SIGPIPE, SIG_IGN);
    EXPECT_EQ(error_of([&] { render_scene({.folder = folder, .program = program}); }).status,
              Status::PovrayFailed);
    std::signal(SIGPIPE, SIG_DFL);
    close(leak);
    unsetenv("LODESTONE_TEST_LEAK");
    const std::string environment = read_file(folder / "env.txt");
    EXPECT_NE(environment.find("LC_ALL=C\n"), std::string::npos);
    EXPECT_NE(environment.find("PATH="), std::string::npos);
    EXPECT_NE(environment.find("GLIBC_TUNABLES=glibc.malloc."), std::string::npos);
    EXPECT_EQ(environment.find("LODESTONE_TEST_LEAK"), std::string::npos);
    EXPECT_EQ(read_file(folder / "fd.txt").find(text(leak, '\n')), std::string::npos);
}

TEST(PovrayRunner, HowMemoryIsAskedForIsTheUsersWhereTheySayIt) {
    const auto folder = scene_with("tunables", kSphere);
    const std::string program = script(folder, "env > env.txt; exit 1\n");
    setenv("GLIBC_TUNABLES", "glibc.malloc.check=0", 1);
    EXPECT_EQ(error_of([&] { render_scene({.folder = folder, .program = program}); }).status,
              Status::PovrayFailed);
    unsetenv("GLIBC_TUNABLES");
    const std::string environment = read_file(folder / "env.txt");
    EXPECT_NE(environment.find("GLIBC_TUNABLES=glibc.malloc.check=0\n"), std::string::npos);
    EXPECT_EQ(environment.find("arena_max"), std::string::npos);
}

TEST(PovrayRunner, AStubbornProgramIsStoppedWithinASecond) {
    const auto folder = scene_with("stubborn", kSphere);
    // Ignores the request, floods the pipe, has a child of its own and leaves a partial picture.
    const std::string program = script(folder,
                                       "trap '' TERM\ntouch ${2#+O}\nsleep 100 &\necho $! > child\n"
                                       "while :; do echo 'Rendered 1 of 2 pixels'; done\n");
    volatile int32_t cancel = 0;
    volatile int32_t stage = 0;
    volatile double fraction = 0;
    std::chrono::steady_clock::time_point asked;
    std::thread killer([&] {
        for (int i = 0; i < 500 && stage != static_cast<int32_t>(JobStage::Trace); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        asked = std::chrono::steady_clock::now();
        cancel = 1;
    });
    const Error error = error_of([&] {
        render_scene({.folder = folder, .program = program}, Job(&cancel, &stage, &fraction));
    });
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    killer.join();
    EXPECT_EQ(error.status, Status::Cancelled);
    EXPECT_LT(took, 1);
    EXPECT_GT(fraction, 0.5);
    EXPECT_LT(fraction, 0.7);
    EXPECT_EQ(files_in(folder), 4u);  // scene.pov, scene.ini, program.sh, child
    const int grandchild = std::stoi(read_file(folder / "child"));
    EXPECT_TRUE(gone(grandchild, 100));
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);  // no zombie of ours
}

TEST(PovrayRunner, KillingTheHostKillsTheProgram) {
    const auto folder = scene_with("orphan", kSphere);
    const std::string program = script(folder, "echo $$ > child; exec sleep 100\n");
    const pid_t host = fork();
    if (host == 0) {
        error_of([&] { render_scene({.folder = folder, .program = program}); });
        _exit(0);
    }
    for (int i = 0; i < 500 && read_text(folder / "child").empty(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const int child = std::stoi(read_text(folder / "child"));
    EXPECT_FALSE(gone(child, 1));
    kill(host, SIGKILL);
    waitpid(host, nullptr, 0);
    EXPECT_TRUE(gone(child, 100));
}

// From here on the real program.

TEST(PovrayRunner, APictureAppearsWithItsReport) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const auto folder = scene_with("plain \xe5\x90\x8d '\"", kSphere);
    volatile int32_t cancel = 0;
    volatile int32_t stage = 0;
    volatile double fraction = 0;
    RunOptions options{.folder = folder, .width = 40, .height = 20, .threads = 1};
    options.output = OutputFormat::Ppm;
    const RunReport report = render_scene(options, Job(&cancel, &stage, &fraction));
    EXPECT_EQ(report.exit_code, 0);
    EXPECT_EQ(report.picture, folder / "picture.ppm");
    EXPECT_EQ(scenes::read_ppm(report.picture).width, 40);
    EXPECT_EQ(report.messages, "");
    EXPECT_GT(report.peak_bytes, 4u << 20u);
    EXPECT_LT(report.peak_bytes, 200u << 20u);
    EXPECT_GT(report.wall_s, 0);
    EXPECT_EQ(stage, static_cast<int32_t>(JobStage::Trace));
    EXPECT_DOUBLE_EQ(fraction, 1);
    EXPECT_EQ(files_in(folder), 3u);
    options.output = OutputFormat::Exr;
    options.output_name = "a.exr";
    EXPECT_EQ(read_file(render_scene(options).picture).substr(0, 4), "\x76\x2f\x31\x01");
    options.output = OutputFormat::Png;
    options.output_name = "a.png";
    EXPECT_EQ(read_file(render_scene(options).picture).substr(1, 3), "PNG");
    EXPECT_EQ(files_in(folder), 5u);
}

TEST(PovrayRunner, AFinishedPictureIsSpreadByItsFilter) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // A white half: the edge is between the columns 15 and 16.
    const std::string half =
        "global_settings{assumed_gamma 1} camera{orthographic location z*-1 look_at 0 right x*2 "
        "up y*2} box{<0,-2,0><2,2,1> pigment{rgb 1} finish{ambient 1 emission 0 diffuse 0}}";
    const auto folder = scene_with("spread", half);
    RunOptions options{.folder = folder, .threads = 1, .spread = 0.1};
    const image::Image exr = image::read(render_scene(options).picture);
    const auto red = [](const image::Image& image, int x, int y) {
        return image.pixels[4 * static_cast<size_t>(y * image.width + x)];
    };
    EXPECT_NEAR(red(exr, 14, 9), 0, 1e-3);
    EXPECT_NEAR(red(exr, 15, 9), 0.05, 1e-3);
    EXPECT_NEAR(red(exr, 16, 9), 0.95, 1e-3);
    EXPECT_NEAR(red(exr, 17, 9), 1, 1e-3);
}

TEST(PovrayRunner, AFailingSceneGivesPovraysOwnSentence) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const auto folder = scene_with("failing", "#include \"r/0123456789abcdef.inc\"\n");
    std::ofstream(folder / "r/0123456789abcdef.inc") << "#declare X =\nmesh2{ nothing }\n";
    std::ofstream(folder / "picture.exr") << "old";
    const Error error = error_of([&] { render_scene({.folder = folder}); });
    EXPECT_EQ(error.status, Status::PovrayFailed);
    EXPECT_TRUE(says(error, "File 'r/0123456789abcdef.inc' line 2: Parse Error:")) << error.what();
    EXPECT_EQ(read_file(folder / "picture.exr"), "old");
    EXPECT_EQ(files_in(folder), 3u);
}

TEST(PovrayRunner, CancellingEndsPovrayWithinASecond) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const auto folder = scene_with("cancel", kSlow, "Width=1920\nHeight=1080\nAntialias=On\n");
    volatile int32_t cancel = 0;
    volatile int32_t stage = 0;
    volatile double fraction = 0;
    std::chrono::steady_clock::time_point asked;
    std::thread killer([&] {
        for (int i = 0; i < 500 && stage != static_cast<int32_t>(JobStage::Trace); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        asked = std::chrono::steady_clock::now();
        cancel = 1;
    });
    const Error error = error_of(
        [&] { render_scene({.folder = folder, .threads = 2}, Job(&cancel, &stage, &fraction)); });
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    killer.join();
    EXPECT_EQ(error.status, Status::Cancelled);
    EXPECT_LT(took, 1);
    EXPECT_EQ(stage, static_cast<int32_t>(JobStage::Trace));
    EXPECT_EQ(files_in(folder), 2u);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

namespace {

/// What was handed out of a live picture, put together, top row first.
std::vector<LivePixel> put_together(LivePicture& live) {
    const auto width = static_cast<size_t>(live.part().width);
    std::vector<LivePixel> out(live.pixels());
    std::vector<LivePixel> room(4096);
    while (const auto where = live.take(false, room)) {
        for (int y = 0; y < where->height; ++y) {
            for (int x = 0; x < where->width; ++x)
                out[static_cast<size_t>(where->top + y) * width +
                    static_cast<size_t>(where->left + x)] =
                    room[static_cast<size_t>(y) * static_cast<size_t>(where->width) +
                         static_cast<size_t>(x)];
        }
    }
    return out;
}

/// The largest relative difference of two pictures' values; those below 1/1000 count as that.
double difference(const std::vector<LivePixel>& live, const image::Image& finished) {
    double worst = live.size() == finished.size() ? 0 : 1e9;
    for (size_t i = 0; i < std::min(live.size(), finished.size()); ++i) {
        for (size_t c = 0; c < 4; ++c) {
            const double expected = finished.pixels[4 * i + c];
            worst = std::max(worst,
                             std::abs(live[i][c] - expected) / std::max(1e-3, std::abs(expected)));
        }
    }
    return worst;
}

const char* const kGlass =
    "global_settings{assumed_gamma 1} camera{location <0,1,-4> look_at 0}\n"
    "light_source{<5,8,-5> rgb 2 area_light 2*x,2*z,17,17} sphere{0,1 pigment{rgbt "
    "<.9,.3,.1,.5>}}\n"
    "box{<-3,-1,0>,<0,-.9,2> pigment{rgb <.2,.5,.1>} finish{ambient 4}}\n";

}  // namespace

TEST(PovrayRunner, TheLivePictureIsTheFinishedOne) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const std::string sizes[] = {
        "Width=100\nHeight=70\nOutput_Alpha=On\nAntialias=On\nAntialias_Threshold=0.1\n",
        "Width=100\nHeight=70\nOutput_Alpha=Off\n",
        "Width=100\nHeight=70\nOutput_Alpha=On\nStart_Column=21\nEnd_Column=90\nStart_Row=11\n"
        "End_Row=50\n"};
    for (const std::string& size : sizes) {
        const bool border = size.find("Start") != std::string::npos;
        const PixelRectangle part =
            border ? PixelRectangle{20, 10, 70, 40} : PixelRectangle{0, 0, 100, 70};
        const auto folder = scene_with("live", kGlass, size);
        LivePicture live(part);
        RunOptions options{.folder = folder, .threads = 2, .live = &live, .mosaic = true};
        volatile int32_t cancel = 0;
        volatile int32_t stage = 0;
        volatile double fraction = 0;
        const RunReport report = render_scene(options, Job(&cancel, &stage, &fraction));
        EXPECT_EQ(live.finished(), live.pixels());
        EXPECT_DOUBLE_EQ(fraction, 1);
        const image::Image finished =
            image::read_region(report.picture, {part.left, part.top, part.width, part.height});
        // POV-Ray writes numbers of 11 bits into an EXR.
        EXPECT_LT(difference(put_together(live), finished), 1.0 / 2048 + 1e-6) << size;
        // Neither looking nor the mosaic changes a bit of it. (Outside a border it does.)
        options.live = nullptr;
        options.mosaic = false;
        options.output_name = "plain.exr";
        const image::Image plain = image::read_region(
            render_scene(options).picture, {part.left, part.top, part.width, part.height});
        EXPECT_EQ(plain.pixels, finished.pixels) << size;
        EXPECT_EQ(files_in(folder), 4u);  // scene.pov, scene.ini and two pictures
    }
}

TEST(PovrayRunner, WhatWasDrawnStaysWhenItIsCancelled) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const auto folder = scene_with("live_cancel", kSlow, "Width=1920\nHeight=1080\nAntialias=On\n");
    LivePicture live({0, 0, 1920, 1080});
    volatile int32_t cancel = 0;
    volatile int32_t stage = 0;
    volatile double fraction = 0;
    std::thread killer([&] {
        for (int i = 0; i < 2000 && live.finished() == 0; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        cancel = 1;
    });
    const Error error = error_of([&] {
        render_scene({.folder = folder, .threads = 2, .live = &live, .mosaic = false},
                     Job(&cancel, &stage, &fraction));
    });
    killer.join();
    EXPECT_EQ(error.status, Status::Cancelled);
    EXPECT_GE(live.finished(), 1024u);
    EXPECT_LT(live.finished(), live.pixels());
    const auto pixels = put_together(live);
    EXPECT_GT(std::count_if(pixels.begin(), pixels.end(),
                            [](const LivePixel& pixel) { return pixel[3] > 0; }),
              1000);
    EXPECT_EQ(files_in(folder), 2u);
}

TEST(PovrayRunner, AnEmptySceneIsMeasuredOnceAndIsTheLeast) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    View view = scenes::above(640, 360);
    RunOptions like;
    like.threads = 1;
    const uint64_t empty = empty_scene_bytes(view, Antialiasing::Off, like);
    EXPECT_GT(empty, 5u << 20u);
    EXPECT_LT(empty, 60u << 20u);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(empty_scene_bytes(view, Antialiasing::Off, like), empty);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(50));

    // A hundred thousand triangles more are seen as such, by what each of them costs.
    scenes::Builder builder;
    builder.place(builder.mesh(shapes::terrain(224)));
    ExportOptions options;
    options.folder = scratch("memory");
    options.antialiasing = Antialiasing::Off;
    Problems problems;
    scenes::write(builder.finish(), view, options, problems);
    like.folder = options.folder;
    const RunReport report = render_scene(like);
    const double each =
        (static_cast<double>(report.peak_bytes) - static_cast<double>(empty)) / (2 * 224 * 224);
    EXPECT_GT(each, 150);
    EXPECT_LT(each, 400);
    EXPECT_GT(report.parse_cpu_s, 0.05);
    EXPECT_LT(report.parse_cpu_s, 3);
}
