// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/options.hpp"

#include <charconv>
#include <vector>

#include <CLI/CLI.hpp>

#include "scene/cache.hpp"

namespace phantom::view {

namespace {

constexpr const char* about =
    "Touch a scene with the mouse, or look at a recorded touch.\n"
    "SCENE is a mesh (PLY, OBJ, STL, OFF, VTP, VTK, 3DS, glTF) or a scene file (.toml).";

constexpr const char* keys =
    "In the window:\n"
    "  left button      press on the surface: the simulated arm comes there; drag: it follows in a\n"
    "                   plane parallel to the screen\n"
    "  wheel, up, down  push the arm in, pull it out, along the line of sight\n"
    "  right button     turn the view; with Shift: move it\n"
    "  middle button    zoom; also Ctrl with the wheel\n"
    "  space            force to zero and STOP; again: START, the force ramps up\n"
    "  c                clear a fault\n"
    "  r                the first view again\n"
    "  s                write a picture (--screenshot's file, else fdhview.png)\n"
    "  q                ramp the force down and quit\n"
    "The arm hangs on the mouse by a spring, as a hand holds it: push deeper to press harder.\n";

/// Numbers separated by one character, exactly `count` of them.
std::vector<double> numbers(const std::string& text, char separator, std::size_t count)
{
    std::vector<double> values;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at <= end) {
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{} || !std::isfinite(value))
            return {};
        values.push_back(value);
        if (next == end)
            break;
        if (*next != separator)
            return {};
        at = next + 1;
    }
    return values.size() == count ? values : std::vector<double>{};
}

std::string parse_size(const std::string& text, Options& options)
{
    constexpr double low = 320, high = 8192;
    const auto size = numbers(text, 'x', 2);
    if (size.empty())
        return "--size: '" + text + "' is no size, expected e.g. 1280x800";
    for (const double side : size)
        if (side < low || side > high || side != std::floor(side))
            return "--size: '" + text + "': each side is a whole number from 320 to 8192";
    options.width = static_cast<int>(size[0]);
    options.height = static_cast<int>(size[1]);
    return {};
}

std::string parse_camera(const std::string& text, Options& options)
{
    const auto values = numbers(text, ',', 3);
    if (values.empty())
        return "--camera: '" + text + "' is not AZ,EL,ZOOM, expected e.g. 25,15,1";
    if (std::abs(values[1]) > 89 || values[2] < 0.01 || values[2] > 1000)
        return "--camera: elevation is from -89 to 89 degrees, zoom from 0.01 to 1000";
    options.camera = CameraAngles{values[0], values[1], values[2]};
    return {};
}

void add_scene_options(CLI::App& app, Options& options, std::string& prepare, bool& use_cache)
{
    app.add_option("scene", options.scene, "mesh or scene file")->required()->type_name("SCENE");
    app.add_option("--unit", options.load.unit, "of the file's coordinates: mm, m, cm, in, um");
    app.add_option("--weld", options.load.prepare.weld_mm, "vertices no farther apart than this are one, mm");
    app.add_option("--fit", options.load.prepare.fit_mm, "scale the longest side to this and centre it, mm")
        ->check(CLI::PositiveNumber);
    app.add_option("--stiffness", options.load.stiffness_n_mm, "of every material, N/mm")
        ->check(CLI::PositiveNumber);
    app.add_option("--radius", options.load.radius_mm, "contact radius of every material, mm")
        ->check(CLI::PositiveNumber);
    app.add_option("--crease", options.load.prepare.crease_deg, "edges sharper than this stay sharp, degrees")
        ->check(CLI::Range(0.0, 180.0));
    app.add_option("--split", options.load.prepare.split_mm, "edges longer than this are cut, mm");
    app.add_option("--prepare", prepare, "full, or none: faces and normals as the file gives them")
        ->check(CLI::IsMember({"full", "none"}));
    app.add_flag("!--no-cache", use_cache, "prepare the meshes anew");
}

void add_live_options(CLI::App& app, Options& options)
{
    app.add_flag("--usermode", options.usermode, "do not look for the kernel's device");
    app.add_flag("!--no-control", options.control,
                 "do not let fdhctl status, rate, model, effect and stop reach us");
    app.add_option("--rate", options.rate_hz, "servo rate, Hz")->check(CLI::Range(1000, 10000));
    app.add_option("--seconds", options.seconds, "end after this time")->check(CLI::PositiveNumber);
    app.add_option("--script", options.script,
                   "CSV that moves the mouse: time_s,x,y,press,depth_mm; x and y from 0 (left, lower edge of "
                   "the view) to 1");
}

} // namespace

std::variant<Options, int> parse_options(int argc, char** argv)
{
    Options options;
    std::string size, camera, prepare = "full";
    CLI::App app{about, "fdhview"};
    app.footer(keys);
    bool use_cache = true;
    add_scene_options(app, options, prepare, use_cache);
    add_live_options(app, options);
    auto* trace = app.add_option("--trace", options.trace, "show a recorded trace (CSV of fdhctl trace)");
    app.add_option("--at-row", options.at_row, "row of the trace to show, from 0; default: the largest force")
        ->needs(trace);
    app.add_option("--screenshot", options.screenshot, "write a PNG and end; needs no display");
    app.add_option("--chart", options.chart, "write force over time as a PNG; needs no display");
    app.add_option(
           "--survey", options.survey,
           "write a PNG of creases, rims, faults and of where triangles are too fine, and end; needs no "
           "display")
        ->excludes(trace);
    app.add_option("--feed-rate", options.feed_hz, "sets a second that --survey reckons with")
        ->check(CLI::PositiveNumber);
    app.add_flag("--window", options.window, "open a window all the same; pictures are taken at the end");
    app.add_option("--size", size, "of the window or picture, e.g. 1280x800");
    app.add_option("--camera", camera, "AZ,EL,ZOOM: azimuth and elevation in degrees, 1 = all in view");
    app.add_flag("--json", options.json, "print a summary as JSON at the end");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    std::string wrong;
    if (!size.empty())
        wrong = parse_size(size, options);
    if (wrong.empty() && !camera.empty())
        wrong = parse_camera(camera, options);
    if (!wrong.empty()) {
        std::fprintf(stderr, "fdhview: %s\n", wrong.c_str());
        return 2;
    }
    options.load.prepare.full = prepare == "full";
    if (use_cache)
        options.load.cache = scene::cache_directory();
    return options;
}

} // namespace phantom::view
