// SPDX-License-Identifier: GPL-3.0-or-later
// Guards writing a store: one writer at a time, others wait, a cancelled one leaves what was there.
#include "base/files.h"
#include "scenes/small_models.h"
#include "scratch.h"
#include "segment/store.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

using namespace lodestone;

TEST(StoreWriters, TwoWritersOfOneStoreAreBothDone) {
    const segment::Store store(scratch("writers_locked"));
    Model model = models::row_of_balls(2);
    model.objects[0].name = "second";
    store.write(models::row_of_balls(2), {});
    std::thread second;
    {
        const FileLock lock(store.folder() / "lock");
        second = std::thread([&] { store.write(model, {}); });
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_NE(store.read().objects[0].name, model.objects[0].name);  // readers never wait
    }
    second.join();
    EXPECT_EQ(store.read().objects[0].name, model.objects[0].name);
}

TEST(StoreWriters, WaitingForAnotherWriterCanBeCancelled) {
    const segment::Store store(scratch("writers_waiting"));
    store.write(models::row_of_balls(2), {});
    const FileLock lock(store.folder() / "lock");
    const int32_t cancel = 1;
    try {
        store.write(models::row_of_balls(4), Job(&cancel, nullptr, nullptr));
        ADD_FAILURE() << "written while another one writes";
    } catch (const Error& error) {
        EXPECT_EQ(error.status, Status::Cancelled);
    }
}

TEST(StoreWriters, CancelledWriteLeavesTheOldStore) {
    const segment::Store store(scratch("writers_cancelled"));
    store.write(models::row_of_balls(2), {});
    const auto before = read_file(store.folder() / "tileset.json");
    const int32_t cancel = 1;
    EXPECT_THROW(store.write(models::row_of_balls(4), Job(&cancel, nullptr, nullptr)), Error);
    EXPECT_EQ(read_file(store.folder() / "tileset.json"), before);
}
