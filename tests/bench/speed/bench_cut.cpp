// SPDX-License-Identifier: GPL-3.0-or-later
// What choosing costs: `cmake --build build/release --target bench_cut`, then
// build/release/tests/bench_cut. A plain of 4^10 = 1,048,576 houses in groups of four, each group
// with a stand-in; the Pixel Error is such that about 20,000 things are chosen. Prints nanoseconds
// a visit and milliseconds a cut (goals: 100 and 5), least / median / most of 21 cuts, once with
// every level's groups shared, once without; the same through a lens around the eye; what making
// the table costs (once per change of the model) and finding the Pixel Error for a budget of
// memory. Then the eye moves: milliseconds of the cut that goes along with it, and of whole ones in
// turns with it, each the mean of 50 steps, least / median / most of five walks.
#include "base/clock.h"
#include "choose/cut_budget.h"
#include "choose/follow/cut_stepper.h"
#include "scenes/small_models.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

using namespace lodestone;

namespace {

constexpr int kDepth = 10;
constexpr size_t kWanted = 20000;
constexpr int kCuts = 21;
constexpr int kWalks = 5;
constexpr int kSteps = 50;

void add_box(Model& model, ObjectIndex object, double error, double half) {
    Representation box;
    box.summary.kind = Kind::Box;
    box.payload = Primitive{{0, 0, 0}, glm::dmat3(1.0), {half, half, 1}};
    box.materials = {0};
    summarize(box, model);
    box.summary.error = error;
    model.objects[object].representations.push_back(std::move(box));
}

/// Groups below `depth`, made anew for each of their uses down to `own` levels below the root.
ObjectIndex plain(Model& model, ObjectIndex house, int depth, int own,
                  std::vector<ObjectIndex>& shared) {
    if (depth == 0)
        return house;
    if (own <= 0 && shared[static_cast<size_t>(depth)] != kNoObject)
        return shared[static_cast<size_t>(depth)];
    const double half = 10.0 * static_cast<double>(1u << static_cast<unsigned>(depth - 1));
    std::vector<Placement> four;
    for (int i = 0; i < 4; ++i) {
        Placement one;
        one.object = plain(model, house, depth - 1, own - 1, shared);
        one.transform = models::moved(i % 2 == 0 ? -half : half, i / 2 == 0 ? -half : half, 0);
        one.name = std::to_string(i);
        four.push_back(std::move(one));
    }
    const ObjectIndex made =
        models::add_group(model, "group " + std::to_string(model.objects.size()), std::move(four));
    add_box(model, made, 4.0 * static_cast<double>(depth), 2 * half);
    if (own <= 0)
        shared[static_cast<size_t>(depth)] = made;
    return made;
}

View view_of(double pixel_error) {
    View view;
    view.camera.position = {100, 200, 30};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0, 0.5625};
    view.width = 1920;
    view.height = 1080;
    view.pixel_error = pixel_error;
    return view;
}

/// Least / median / most of some runs, in `unit`s.
template <typename Run>
void print_times(int runs, double unit, const Run& run) {
    std::vector<double> seconds;
    for (int i = 0; i < runs; ++i) {
        const double start = cpu_seconds();
        run();
        seconds.push_back(cpu_seconds() - start);
    }
    std::sort(seconds.begin(), seconds.end());
    std::printf(" %.3g / %.3g / %.3g |", unit * seconds.front(), unit * seconds[seconds.size() / 2],
                unit * seconds.back());
}

/// A walk of equal steps, a cut that goes along and a whole one in turns. Steps of 0 turn the
/// camera.
void bench_steps(const std::shared_ptr<const choose::ChoiceTable>& table, View view, double metres,
                 const char* what, const char* how, bool lenses_move = false) {
    choose::CutStepper stepper(table);
    choose::Cut cut;
    stepper.step(view, cut);
    std::vector<double> steps;
    std::vector<double> wholes;
    std::vector<double> ratios;
    double looked = 0;
    double angle = 0;
    for (int walk = 0; walk < kWalks; ++walk) {
        double step_s = 0;
        double whole_s = 0;
        for (int i = 0; i < kSteps; ++i) {
            // Out into the plain and back, on a way that ends where it began.
            const double on = i < kSteps / 2 ? metres : -metres;
            view.camera.position.y += on;
            for (DetailLens& lens : view.modifiers.lenses)
                lens.transform.offset.y += lenses_move ? on : 0;
            if (metres == 0) {
                angle += 0.01;
                view.camera.right = {std::cos(angle), std::sin(angle), 0};
                view.camera.direction = {-std::sin(angle), std::cos(angle), 0};
            }
            const double start = cpu_seconds();
            stepper.step(view, cut);
            const double middle = cpu_seconds();
            const size_t chosen = choose::choose_cut(*table, view).chosen.size();
            whole_s += cpu_seconds() - middle;
            step_s += middle - start;
            looked += static_cast<double>(stepper.decided_nodes());
            if (chosen != cut.chosen.size()) {
                std::printf("wrong: %zu chosen, not %zu\n", cut.chosen.size(), chosen);
                std::exit(1);
            }
        }
        steps.push_back(1e3 / kSteps * step_s);
        wholes.push_back(1e3 / kSteps * whole_s);
        ratios.push_back(step_s / whole_s);
    }
    std::printf("| %s, %s, steps of %g m | %.0f decided again |", what, how, metres,
                looked / (kWalks * kSteps));
    for (std::vector<double>* values : {&steps, &wholes, &ratios}) {
        std::sort(values->begin(), values->end());
        std::printf(" %.3g / %.3g / %.3g |", values->front(), (*values)[values->size() / 2],
                    values->back());
    }
    std::printf("\n");
}

void bench(const char* what, int own) {
    Model model;
    const ObjectIndex house = models::add_leaf(model, "house", shapes::sphere(5, 2));
    add_box(model, house, 0.5, 5);
    std::vector<ObjectIndex> shared(kDepth + 1, kNoObject);
    model.root = plain(model, house, kDepth, own, shared);
    summarize_assemblies(model, bottom_up(model));
    const auto kept = std::make_shared<const choose::ChoiceTable>(
        choose::ChoiceTable::whole(model, model.root, kAllKinds));
    const choose::ChoiceTable& table = *kept;
    double fine = 0;
    double coarse = 1000;
    for (int i = 0; i < 40; ++i) {
        const double middle = (fine + coarse) / 2;
        const size_t chosen = choose::choose_cut(table, view_of(middle)).chosen.size();
        (chosen > kWanted ? fine : coarse) = middle;
    }
    View view = view_of(coarse);
    const auto row = [&](const char* how) {
        const choose::Cut cut = choose::choose_cut(table, view);
        const double visits = static_cast<double>(cut.nodes.size());
        std::printf("| %s, %s | %zu | %zu | %zu |", what, how, model.objects.size(),
                    cut.nodes.size(), cut.chosen.size());
        for (const double unit : {1e9 / visits, 1e3})
            print_times(kCuts, unit, [&] { choose::choose_cut(table, view); });
        std::printf("\n");
    };
    row("plain");
    DetailLens lens;
    lens.transform = models::moved(150, 260, 0);
    lens.radius = 60;
    lens.strength = 2;
    view.modifiers.lenses = {lens};
    row("one lens");
    view.modifiers.lenses.clear();
    const choose::Cut cut = choose::choose_cut(table, view);
    std::printf("| %s, table | %zu | | | |", what, model.objects.size());
    print_times(5, 1e3, [&] { choose::ChoiceTable::whole(model, model.root, kAllKinds); });
    std::printf("\n| %s, budget | %zu | | %zu | |", what, model.objects.size(), cut.chosen.size());
    View fine_view = view;
    fine_view.pixel_error = 0;
    print_times(5, 1e3, [&] { choose::fit_cut_to_budget(table, fine_view, {0, cut.bytes}); });
    std::printf("\n");
    for (const double metres : {0.0, 0.1, 1.0, 10.0, 100.0})
        bench_steps(kept, view, metres, what, "plain");
    view.modifiers.lenses = {lens};
    bench_steps(kept, view, 1, what, "one lens");
    bench_steps(kept, view, 1, what, "one lens that moves along", true);
}

}  // namespace

int main() {
    std::printf(
        "| groups | objects | visits | chosen | ns a visit | ms a cut |\n"
        "|---|---|---|---|---|---|\n");
    bench("shared", 0);
    bench("each its own", kDepth);
    return 0;
}
