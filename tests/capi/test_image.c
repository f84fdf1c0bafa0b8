/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Guards pictures as a C program sees them: what is written is read back, either way up, and
   differs from itself by nothing. */
#include "cube.h"

enum { WIDTH = 24, HEIGHT = 16, NUMBERS = WIDTH * HEIGHT * 4 };

/* Red rises with x, green with y; opaque. */
static void paint(float* pixels, float blue) {
    for (int y = 0; y < HEIGHT; ++y) {
        for (int x = 0; x < WIDTH; ++x) {
            float* pixel = pixels + 4 * (y * WIDTH + x);
            pixel[0] = (float)x / (WIDTH - 1);
            pixel[1] = (float)y / (HEIGHT - 1);
            pixel[2] = blue;
            pixel[3] = 1;
        }
    }
}

static void test_a_picture_comes_back_either_way_up(void) {
    static float given[NUMBERS];
    static float back[NUMBERS];
    paint(given, 0.25f);
    EXPECT(lds_image_write_png("capi_given.png", 0, HEIGHT, given) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_write_png("no_such_folder/a.png", WIDTH, HEIGHT, given) == LDS_ERROR_IO);
    EXPECT(lds_image_write_png("capi_given.png", WIDTH, HEIGHT, given) == LDS_OK);
    int32_t width = -1;
    int32_t height = -1;
    EXPECT(lds_image_size("no_such_file.png", &width, &height) != LDS_OK && width == -1);
    EXPECT(lds_image_size("capi_given.png", &width, &height) == LDS_OK);
    EXPECT(width == WIDTH && height == HEIGHT);
    back[0] = -1;
    EXPECT(lds_image_read("capi_given.png", 0, back, NUMBERS - 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(back[0] == -1);
    EXPECT(lds_image_read("capi_given.png", 0, back, NUMBERS) == LDS_OK);
    for (int i = 0; i < NUMBERS; ++i)
        EXPECT(fabsf(back[i] - given[i]) < 0.005f); /* half a step of 8-bit sRGB near white */
    EXPECT(lds_image_read("capi_given.png", 1, back, NUMBERS) == LDS_OK);
    for (int y = 0; y < HEIGHT; ++y)
        EXPECT(fabsf(back[4 * y * WIDTH + 1] - given[4 * (HEIGHT - 1 - y) * WIDTH + 1]) < 0.005f);
}

static void test_parts_are_those_of_an_exr_alone(void) {
    static float pixels[NUMBERS];
    const int32_t part[4] = {0, 0, 1, 1};
    paint(pixels, 0);
    EXPECT(lds_image_write_png("capi_part.png", WIDTH, HEIGHT, pixels) == LDS_OK);
    EXPECT(lds_image_read_part("capi_part.png", part, 0, pixels, NUMBERS) == LDS_ERROR_BAD_FILE);
    EXPECT(lds_image_read_part("no_such_file.exr", part, 0, pixels, NUMBERS) == LDS_ERROR_IO);
    EXPECT(lds_image_read_part(NULL, part, 0, pixels, NUMBERS) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_read_part("a.exr", NULL, 0, pixels, NUMBERS) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_read_part("a.exr", part, 0, NULL, 0) == LDS_ERROR_INVALID_ARGUMENT);
}

static void test_text_is_added_to_a_png_alone(void) {
    static float pixels[NUMBERS];
    paint(pixels, 0);
    const char* keywords[] = {"Lodestone", "Pixel Error"};
    const char* texts[] = {"0.1.0", NULL};
    EXPECT(lds_image_write_png("capi_text.png", WIDTH, HEIGHT, pixels) == LDS_OK);
    EXPECT(lds_image_add_text("capi_text.png", keywords, texts, 2) == LDS_OK);
    EXPECT(lds_image_add_text("capi_text.png", NULL, NULL, 0) == LDS_OK);
    EXPECT(lds_image_add_text("capi_text.png", NULL, texts, 1) == LDS_ERROR_INVALID_ARGUMENT);
    EXPECT(lds_image_add_text("no_such_file.png", keywords, texts, 2) == LDS_ERROR_IO);
    int32_t width = 0;
    int32_t height = 0;
    EXPECT(lds_image_size("capi_text.png", &width, &height) == LDS_OK && width == WIDTH);
}

static void test_differences_are_those_that_were_painted(void) {
    static float pixels[NUMBERS];
    paint(pixels, 0);
    EXPECT(lds_image_write_png("capi_a.png", WIDTH, HEIGHT, pixels) == LDS_OK);
    pixels[2] = 1; /* one blue corner */
    EXPECT(lds_image_write_png("capi_b.png", WIDTH, HEIGHT, pixels) == LDS_OK);
    for (int i = 3 + 4 * WIDTH; i < NUMBERS; i += 4)
        memset(pixels + i - 3, 0, 4 * sizeof pixels[0]);
    EXPECT(lds_image_write_png("capi_mask.png", WIDTH, HEIGHT, pixels) == LDS_OK); /* top row */
    lds_difference same;
    memset(&same, 0, sizeof same);
    same.struct_size = sizeof same;
    EXPECT(lds_image_compare("capi_a.png", "capi_a.png", NULL, &same) == LDS_OK);
    EXPECT(same.mean == 0 && same.max == 0 && fabs(same.ssim - 1) < 1e-9);
    EXPECT(same.pixels == WIDTH * HEIGHT);
    lds_difference all = same;
    EXPECT(lds_image_compare("capi_a.png", "capi_b.png", NULL, &all) == LDS_OK);
    EXPECT(all.mean > 0 && fabs(all.max - 1) < 1e-6 && all.ssim < 1);
    lds_difference row = same;
    EXPECT(lds_image_compare("capi_a.png", "capi_b.png", "capi_mask.png", &row) == LDS_OK);
    EXPECT(row.pixels == WIDTH && row.mean > all.mean);
    EXPECT(lds_image_compare("capi_a.png", "no_such_file.png", NULL, &same) != LDS_OK);
    EXPECT(same.pixels == WIDTH * HEIGHT);
}

int main(void) {
    test_a_picture_comes_back_either_way_up();
    test_parts_are_those_of_an_exr_alone();
    test_text_is_added_to_a_png_alone();
    test_differences_are_those_that_were_painted();
    return finish();
}
