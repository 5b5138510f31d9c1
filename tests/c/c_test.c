/* The C interface from C: results against closed forms, misuse and bad input as status and text. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lobelia/lobelia_c.h"

static int failures = 0;

#define CHECK(condition)                                                              \
    do {                                                                              \
        if (!(condition)) {                                                           \
            printf("%s:%d: %s  (%s)\n", __FILE__, __LINE__, #condition, lob_error()); \
            ++failures;                                                               \
        }                                                                             \
    } while (0)

#define PI 3.14159265358979323846

static int is_near(double a, double b, double relative) { return fabs(a - b) <= relative * fabs(b); }

/* Stops the program where what follows needs the result. */
static void require(lob_status status, const char* what) {
    if (status == LOB_OK) return;
    printf("%s: status %d, %s\n", what, (int)status, lob_error());
    exit(1);
}

static lob_codec* make_codec(const char* name) {
    lob_codec* codec = NULL;
    require(lob_codec_create(name, &codec), name);
    return codec;
}

/* A constant radiance L gives E = pi L at every normal. */
static void test_white_furnace(void) {
    enum { width = 64, height = 32 };
    const float normals[9] = {0, 1, 0, 1, 0, 0, 0.6f, -0.8f, 0};
    float *pixels = malloc(3 * width * height * sizeof *pixels), c[27], E[9], exact[9], one[3];
    lob_environment* environment = NULL;
    lob_codec* codec = make_codec("sh2/least-squares/convolution");
    size_t i;
    for (i = 0; i < 3 * width * height; ++i) pixels[i] = 0.5f * (float)(1 + i % 3);
    require(lob_environment_from_pixels(pixels, width, height, &environment), "environment");
    free(pixels);
    CHECK(lob_environment_width(environment) == width && lob_environment_height(environment) == height);
    CHECK(lob_environment_pixels(environment)[4] == 1.0f);

    CHECK(lob_codec_size(codec) == 9 && !lob_codec_is_hemispherical(codec));
    CHECK(strcmp(lob_codec_name(codec), "sh2/least-squares/convolution") == 0);
    CHECK(lob_encode_environment(codec, environment, c, 9) == LOB_OK);
    CHECK(lob_irradiance(codec, c, 9, normals, 3, E) == LOB_OK);
    CHECK(lob_environment_irradiance(environment, normals, 3, exact) == LOB_OK);
    for (i = 0; i < 9; ++i) {
        CHECK(is_near(E[i], 0.5 * PI * (double)(1 + i % 3), 1e-3));
        CHECK(is_near(E[i], exact[i], 5e-3));
    }
    /* One at a time gives the same as many. */
    for (i = 0; i < 3; ++i) {
        CHECK(lob_irradiance(codec, c, 9, normals + 3 * i, 1, one) == LOB_OK);
        CHECK(is_near(one[0], E[3 * i], 1e-5) && is_near(one[2], E[3 * i + 2], 1e-5));
    }
    CHECK(lob_radiance(codec, c, 9, normals, 3, E) == LOB_OK);
    for (i = 0; i < 9; ++i) CHECK(is_near(E[i], 0.5 * (double)(1 + i % 3), 1e-3));
    lob_codec_free(codec);
    lob_environment_free(environment);
}

/* A whole sphere of directions: more than one block of evaluation. */
static void test_many_directions(void) {
    enum { count = 1000 };
    lob_environment* sky = NULL;
    lob_codec* codec = make_codec("sg12/least-squares/hill");
    float normals[3 * count], E[3 * count], one[3], c[36];
    size_t i;
    require(lob_environment_sky(64, 32, 3, 40, 45, &sky), "sky");
    CHECK(lob_encode_environment(codec, sky, c, 12) == LOB_OK);
    for (i = 0; i < count; ++i) {
        const double z = 1 - 2 * ((double)i + 0.5) / count, r = sqrt(1 - z * z), phi = 2.399963 * (double)i;
        normals[3 * i] = (float)(r * cos(phi));
        normals[3 * i + 1] = (float)(r * sin(phi));
        normals[3 * i + 2] = (float)z;
    }
    CHECK(lob_irradiance(codec, c, 12, normals, count, E) == LOB_OK);
    for (i = 0; i < count; i += 37) {
        CHECK(lob_irradiance(codec, c, 12, normals + 3 * i, 1, one) == LOB_OK);
        CHECK(is_near(one[0], E[3 * i], 1e-5) && is_near(one[2], E[3 * i + 2], 1e-5));
    }
    lob_codec_free(codec);
    lob_environment_free(sky);
}

/* Fills samples with the six axes, brighter upwards. */
static void six_samples(lob_sample samples[6]) {
    size_t i, k;
    memset(samples, 0, 6 * sizeof *samples);
    for (i = 0; i < 6; ++i) {
        samples[i].direction[i / 2] = i % 2 ? -1.0f : 1.0f;
        for (k = 0; k < 3; ++k) samples[i].radiance[k] = i == 2 ? 2.0f : 1.0f;
        samples[i].solid_angle = (float)(4 * PI / 6);
    }
}

static void test_merge_equals_sequential(void) {
    lob_sample samples[6];
    lob_codec *codec = make_codec("sh1/moments/convolution"), *other_codec = make_codec("sh2/moments/convolution");
    lob_accumulator *all = NULL, *first = NULL, *second = NULL, *other = NULL;
    float a[12], b[12], direct[12];
    size_t i;
    six_samples(samples);
    require(lob_accumulator_create(codec, &all), "accumulator");
    require(lob_accumulator_create(codec, &first), "accumulator");
    require(lob_accumulator_create(codec, &second), "accumulator");
    require(lob_accumulator_create(other_codec, &other), "accumulator");
    CHECK(lob_accumulator_add(all, samples, 6) == LOB_OK);
    CHECK(lob_accumulator_add(first, samples, 2) == LOB_OK);
    CHECK(lob_accumulator_add(second, samples + 2, 4) == LOB_OK);
    CHECK(lob_accumulator_merge(first, second) == LOB_OK);
    CHECK(lob_accumulator_solve(all, a, 4) == LOB_OK);
    CHECK(lob_accumulator_solve(first, b, 4) == LOB_OK);
    CHECK(lob_encode(codec, samples, 6, direct, 4) == LOB_OK);
    for (i = 0; i < 12; ++i) {
        CHECK(fabs(a[i] - b[i]) <= 1e-6);
        CHECK(a[i] == direct[i]);
    }
    CHECK(lob_accumulator_merge(first, other) == LOB_MISUSE);
    CHECK(strstr(lob_error(), "sh2/moments/convolution") != NULL);
    lob_accumulator_free(all);
    lob_accumulator_free(first);
    lob_accumulator_free(second);
    lob_accumulator_free(other);
    lob_codec_free(codec);
    lob_codec_free(other_codec);
}

/* What float32 textures hold is what was packed; smaller storages come near. */
static void test_pack_round_trip(void) {
    enum { width = 5, height = 3, floats = 3 * 4 * width * height };
    lob_codec* codec = make_codec("sh1/least-squares/convolution");
    lob_textures* textures = NULL;
    lob_texture texture;
    float in[floats], out[floats];
    size_t i;
    for (i = 0; i < floats; ++i) in[i] = i % 12 < 3 ? 1.0f + (float)i * 0.01f : 0.1f * (float)(i % 7) - 0.2f;
    require(lob_pack(codec, "float32", in, width, height, &textures), "pack");
    CHECK(lob_unpack(textures, out, floats) == LOB_OK);
    CHECK(memcmp(in, out, sizeof in) == 0);
    CHECK(lob_textures_count(textures) == 3);
    CHECK(lob_textures_get(textures, 0, &texture) == LOB_OK);
    CHECK(texture.width == width && texture.height == height && texture.data != NULL);
    CHECK(texture.vk_format == 109 && texture.bytes == 16 * width * height); /* R32G32B32A32_SFLOAT */
    CHECK(lob_textures_get(textures, 3, &texture) == LOB_MISUSE);
    CHECK(lob_unpack(textures, out, floats - 1) == LOB_MISUSE);
    lob_textures_free(textures);

    textures = NULL;
    require(lob_pack(codec, "ratio8", in, width, height, &textures), "pack");
    CHECK(lob_unpack(textures, out, floats) == LOB_OK);
    for (i = 0; i < floats; ++i) CHECK(fabs(in[i] - out[i]) < 0.05);
    lob_textures_free(textures);
    textures = NULL;
    CHECK(lob_pack(codec, "no-such-storage", in, width, height, &textures) == LOB_BAD_INPUT && textures == NULL);
    CHECK(strstr(lob_error(), "no-such-storage") != NULL);
    lob_codec_free(codec);
}

static void test_errors_are_status_and_text(void) {
    lob_codec* codec = NULL;
    lob_environment* environment = NULL;
    float c[27], bad[3] = {1, -1, 1};
    const float up[3] = {0, 1, 0};
    CHECK(lob_codec_create("sh2/least-squares/convolutoin", &codec) == LOB_BAD_INPUT && codec == NULL);
    CHECK(strstr(lob_error(), "convolution") != NULL);
    CHECK(lob_codec_create(NULL, &codec) == LOB_MISUSE);
    CHECK(lob_environment_load("no such file.hdr", &environment) == LOB_BAD_INPUT && environment == NULL);
    CHECK(strstr(lob_error(), "no such file.hdr") != NULL);
    CHECK(lob_environment_sky(64, 0, 3, 40, 45, &environment) == LOB_BAD_INPUT);
    CHECK(lob_environment_sky(64, 32, 3, -40, 45, &environment) == LOB_BAD_INPUT);
    CHECK(lob_environment_from_pixels(bad, 1, 1, &environment) == LOB_BAD_INPUT);
    codec = make_codec("sh2/least-squares/convolution");
    memset(c, 0, sizeof c);
    CHECK(lob_irradiance(codec, c, 8, up, 1, bad) == LOB_MISUSE);
    CHECK(strstr(lob_error(), "lob_irradiance") != NULL && strstr(lob_error(), "9") != NULL);
    CHECK(lob_irradiance(codec, c, 9, NULL, 1, bad) == LOB_MISUSE);
    lob_codec_free(codec);
    lob_codec_free(NULL);
    lob_environment_free(NULL);
    lob_accumulator_free(NULL);
    lob_textures_free(NULL);
}

struct watch {
    double last;
    int calls;
    lob_stop* stop; /* set at the first call, if there is one */
};

static void watch_progress(void* user, double done, const char* stage) {
    struct watch* watch = user;
    CHECK(done >= 0 && done <= 1 && strcmp(stage, "texels") == 0);
    watch->last = done;
    ++watch->calls;
    if (watch->stop != NULL) lob_stop_set(watch->stop);
}

/* A bake's coefficients give the irradiance that its paths measured, in the mean. */
static void test_bake(void) {
    lob_scene* scene = NULL;
    lob_bake *bake = NULL, *again = NULL;
    lob_bake_options options;
    struct watch watch = {0, 0, NULL};
    const float *c = NULL, *other = NULL, *E = NULL, *validity = NULL;
    size_t i, lit = 0, texels;
    require(lob_scene_load("cornell", &scene), "scene");
    lob_bake_options_init(&options, sizeof options);
    CHECK(options.samples == 256 && options.bounces == 8 && options.denoise == 1);
    options.codec = "sh1/least-squares/convolution";
    options.width = options.height = 32;
    options.samples = 32;
    options.progress = watch_progress;
    options.user = &watch;
    require(lob_bake_scene(scene, &options, &bake), "bake");
    CHECK(watch.calls > 0);
    CHECK(strcmp(lob_bake_codec(bake), options.codec) == 0 && lob_bake_coefficient_count(bake) == 4);
    CHECK(lob_bake_page_count(bake) == 1 && lob_bake_width(bake) == 32 && lob_bake_height(bake) == 32);
    texels = lob_bake_width(bake) * lob_bake_height(bake);
    CHECK(lob_bake_channel(bake, 0, "c0.G", &c) == LOB_OK && lob_bake_channel(bake, 0, "E.G", &E) == LOB_OK);
    CHECK(lob_bake_channel(bake, 0, "validity", &validity) == LOB_OK);
    for (i = 0; i < texels; ++i) {
        CHECK(isfinite(c[i]) && E[i] >= 0 && validity[i] >= 0 && validity[i] <= 1);
        if (c[i] > 0 && E[i] > 0) ++lit;
    }
    CHECK(lit > texels / 4);

    /* The same options give the same bits at another number of threads. */
    options.threads = 1;
    require(lob_bake_scene(scene, &options, &again), "bake again");
    CHECK(lob_bake_channel(again, 0, "c0.G", &other) == LOB_OK);
    CHECK(memcmp(c, other, texels * sizeof *c) == 0);

    CHECK(lob_bake_channel(bake, 1, "c0.G", &c) == LOB_MISUSE);
    CHECK(lob_bake_channel(bake, 0, "c4.G", &c) == LOB_BAD_INPUT);
    lob_bake_free(bake);
    lob_bake_free(again);
    lob_scene_free(scene);
}

static void test_bake_stops_and_refuses(void) {
    lob_scene* scene = NULL;
    lob_environment* sky = NULL;
    lob_bake* bake = NULL;
    lob_bake_options options;
    struct watch watch = {0, 0, NULL};
    require(lob_scene_load("cornell", &scene), "scene");
    require(lob_environment_sky(16, 8, 3, 40, 45, &sky), "sky");
    CHECK(lob_scene_set_environment(scene, sky) == LOB_OK && lob_scene_set_environment(scene, NULL) == LOB_OK);
    require(lob_stop_create(&watch.stop), "stop");
    lob_bake_options_init(&options, sizeof options);
    options.width = options.height = 64;
    options.samples = 100000;
    options.progress = watch_progress;
    options.user = &watch;
    options.stop = watch.stop;
    CHECK(lob_bake_scene(scene, &options, &bake) == LOB_STOPPED && bake == NULL);
    options.samples = 0;
    CHECK(lob_bake_scene(scene, &options, &bake) == LOB_BAD_INPUT && strstr(lob_error(), "samples") != NULL);
    CHECK(lob_bake_read("no such folder", &bake) == LOB_BAD_INPUT && bake == NULL);
    CHECK(lob_scene_load("no such scene.glb", &scene) == LOB_BAD_INPUT);
    lob_stop_free(watch.stop);
    lob_scene_free(scene);
    lob_environment_free(sky);
    lob_bake_free(NULL);
}

int main(void) {
    CHECK(lob_interface() == LOB_INTERFACE);
    CHECK(strcmp(lob_error(), "") == 0);
    test_white_furnace();
    test_many_directions();
    test_merge_equals_sequential();
    test_pack_round_trip();
    test_errors_are_status_and_text();
    test_bake();
    test_bake_stops_and_refuses();
    if (failures == 0) printf("lobelia %s: all passed\n", lob_version());
    return failures == 0 ? 0 : 1;
}
