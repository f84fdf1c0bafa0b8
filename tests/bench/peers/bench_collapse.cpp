// SPDX-License-Identifier: GPL-3.0-or-later
// What simplifying costs within one process, in JSON lines for bench_simplify.py:
//   bench_collapse MODE(fast|best|cluster) TARGET MILLIONS ROUNDS THREADS FILE.ply...
// TARGET: a part of the triangles. MILLIONS of triangles: every triangle of the file is cut into
// four until there are as many, with a little noise; 0 takes it as it is. Wall and CPU seconds of
// every round (the first one with fresh memory) and the most memory beside input, bytes a triangle.
#include "base/clock.h"
#include "base/files.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "format/ply.h"
#include "simplify/cluster/vertex_clustering.h"
#include "simplify/simplify.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <malloc.h>
#include <new>
#include <string>
#include <unordered_map>

using namespace lodestone;

namespace {

std::atomic<size_t> held{0};
std::atomic<size_t> most_held{0};

void* counted(size_t size, size_t alignment) {
    void* at = alignment > 16
                   ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                   : std::malloc(size);
    if (at == nullptr)
        throw std::bad_alloc();
    const size_t now = held += malloc_usable_size(at);
    size_t most = most_held;
    while (now > most && !most_held.compare_exchange_weak(most, now)) {
    }
    return at;
}

void discard(void* at) {
    if (at != nullptr)
        held -= malloc_usable_size(at);
    std::free(at);
}

/// Four triangles for each, the new corners off the middles by a little.
Mesh finer(const Mesh& mesh) {
    Mesh out;
    out.positions = mesh.positions;
    std::unordered_map<uint64_t, uint32_t> middles;
    middles.reserve(mesh.triangles.size() * 2);
    const auto middle = [&](uint32_t a, uint32_t b) {
        const uint64_t key = uint64_t{std::min(a, b)} << 32u | std::max(a, b);
        const auto [entry, fresh] =
            middles.try_emplace(key, static_cast<uint32_t>(out.positions.size()));
        if (fresh) {
            const glm::vec3 p = out.positions[a];
            const glm::vec3 q = out.positions[b];
            uint64_t seed = key * 0x9e3779b97f4a7c15u;
            glm::vec3 noise;
            for (int i = 0; i < 3; ++i) {
                seed ^= seed >> 31u;
                seed *= 0xd6e8feb86659fd93u;
                noise[i] = static_cast<float>(seed >> 40u) / static_cast<float>(1u << 24u) - 0.5f;
            }
            out.positions.push_back(0.5f * (p + q) + 0.05f * glm::length(p - q) * noise);
        }
        return entry->second;
    };
    for (const Triangle& t : mesh.triangles) {
        const uint32_t x = middle(t.y, t.z);
        const uint32_t y = middle(t.z, t.x);
        const uint32_t z = middle(t.x, t.y);
        for (const Triangle& each :
             {Triangle(t.x, z, y), Triangle(z, t.y, x), Triangle(y, x, t.z), Triangle(x, y, z)})
            out.triangles.push_back(each);
    }
    return out;
}

uint64_t bits_of(const Mesh& mesh) {
    uint64_t hash = 14695981039346656037u;
    const auto take = [&](const void* data, size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (size_t i = 0; i < size; ++i)
            hash = (hash ^ bytes[i]) * 1099511628211u;
    };
    take(mesh.positions.data(), mesh.positions.size() * sizeof(glm::vec3));
    take(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
    return hash;
}

}  // namespace

void* operator new(size_t size) {
    return counted(size, 0);
}
void* operator new(size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<size_t>(alignment));
}
void operator delete(void* at) noexcept {
    discard(at);
}
void operator delete(void* at, size_t /*size*/) noexcept {
    discard(at);
}
void operator delete(void* at, std::align_val_t /*alignment*/) noexcept {
    discard(at);
}
void operator delete(void* at, size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    discard(at);
}

int main(int count, char** words) {
    if (count < 7) {
        std::fprintf(stderr, "bench_collapse MODE TARGET MILLIONS ROUNDS THREADS FILE.ply...\n");
        return 2;
    }
    const std::string mode = words[1];
    const double part = std::atof(words[2]);
    const double millions = std::atof(words[3]);
    const int rounds = std::atoi(words[4]);
    const ThreadLimit limit(std::atoi(words[5]));
    for (int i = 6; i < count; ++i) {
        Problems problems;
        Mesh mesh = format::read_ply(read_file(words[i]), words[i], problems);
        mesh.normals.clear();
        repair(mesh, words[i], problems);
        while (static_cast<double>(mesh.triangles.size()) < 1e6 * millions)
            mesh = finer(mesh);
        const auto triangles = static_cast<double>(mesh.triangles.size());
        const auto target = static_cast<size_t>(part * triangles);
        for (int round = 0; round < rounds; ++round) {
            const size_t before = held;
            most_held = before;
            const double cpu = cpu_seconds();
            const auto start = std::chrono::steady_clock::now();
            simplify::SimplifyOptions options;
            if (mode == "best")
                options.mode = simplify::SimplifyMode::Best;
            const Mesh out = mode == "cluster" ? simplify::cluster_vertices(mesh, target)
                                               : simplify::simplify_mesh(mesh, target, options);
            const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
            std::printf(
                "{\"mode\":\"%s\",\"file\":\"%s\",\"triangles\":%.0f,\"got\":%zu,"
                "\"round\":%d,\"wall\":%.4f,\"cpu\":%.4f,\"bytes\":%.1f,"
                "\"hash\":\"%016llx\"}\n",
                mode.c_str(), words[i], triangles, out.triangles.size(), round, wall.count(),
                cpu_seconds() - cpu, static_cast<double>(most_held - before) / triangles,
                static_cast<unsigned long long>(bits_of(out)));
            std::fflush(stdout);
        }
    }
    return 0;
}
