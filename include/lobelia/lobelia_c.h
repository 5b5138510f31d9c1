/* lobelia_c.h: Lobelia for C99, and for whatever can call C.
 *
 *   environment or scene -> encode or bake -> coefficients -> evaluate, pack
 *
 * Objects are opaque handles, made by functions that take `lob_x** out` and released by `lob_x_free`, which accepts
 * NULL. Arrays are a pointer and a count of entries. Directions are unit vectors of three floats that point away from
 * the surface; colours are three floats, linear Rec. 709; radiance is in W/(m^2 sr), irradiance in W/m^2 and never
 * divided by pi (docs/conventions.md). Texels are row by row from the top left.
 *
 * Functions that can fail return a lob_status; lob_error() has the message. Nothing is written to `out` then. No C++
 * exception leaves a function. Handles may be shared between threads as long as nobody changes them (functions that
 * take a pointer to const do not); calls on different handles are independent.
 */
#ifndef LOBELIA_C_H
#define LOBELIA_C_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define LOB_API __attribute__((visibility("default")))
#else
#define LOB_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this interface. It is raised when a function or structure changes; additions leave it. A program checks
 * that lob_interface() of the library that it runs with equals the LOB_INTERFACE that it was compiled with. */
#define LOB_INTERFACE 1
LOB_API int lob_interface(void);
/* Version of the library, such as "0.2.0". */
LOB_API const char* lob_version(void);

typedef enum lob_status {
    LOB_OK = 0,
    LOB_BAD_INPUT = 1, /* a file, a name or an option was refused */
    LOB_MISUSE = 2,    /* a null pointer, or an array whose count does not match */
    LOB_STOPPED = 3,   /* a lob_stop was set */
    LOB_NO_MEMORY = 4,
    LOB_INTERNAL = 5 /* a bug in the library */
} lob_status;

/* Message of the last failure in this thread; "" if there was none. Valid until this thread's next failure. */
LOB_API const char* lob_error(void);

/* Environments: latitude-longitude images, y up ---------------------------------------------------------------- */

typedef struct lob_environment lob_environment;

/* Reads a Radiance .hdr or OpenEXR file. Safe on any bytes. */
LOB_API lob_status lob_environment_load(const char* path, lob_environment** out);
/* Makes the embedded clear sky with its sun. Turbidity is in [2, 10], the elevation in (0, 90] degrees, the azimuth in
 * degrees from -z towards +x. */
LOB_API lob_status lob_environment_sky(size_t width, size_t height, double turbidity, double sun_elevation,
                                       double sun_azimuth, lob_environment** out);
/* Copies width x height colours, finite and not negative. */
LOB_API lob_status lob_environment_from_pixels(const float* pixels, size_t width, size_t height, lob_environment** out);
LOB_API size_t lob_environment_width(const lob_environment* environment);
LOB_API size_t lob_environment_height(const lob_environment* environment);
/* width * height colours, which belong to the environment. */
LOB_API const float* lob_environment_pixels(const lob_environment* environment);
LOB_API void lob_environment_free(lob_environment* environment);

/* Codecs: a basis, an encoder and an evaluator --------------------------------------------------------------------- */

typedef struct lob_codec lob_codec;

typedef struct lob_sample {
    float direction[3];
    float radiance[3];
    float solid_angle; /* share of the domain [sr], 1 / (N pdf); a common factor is harmless */
} lob_sample;

/* Makes a codec from "basis/encoder/evaluator", such as "sh2/least-squares/convolution" (`lobelia list`). */
LOB_API lob_status lob_codec_create(const char* name, lob_codec** out);
LOB_API const char* lob_codec_name(const lob_codec* codec);
/* Number of coefficients, each a colour. */
LOB_API size_t lob_codec_size(const lob_codec* codec);
/* 1 if directions are those of the upper hemisphere of a tangent frame, z >= 0; 0 for the whole sphere. */
LOB_API int lob_codec_is_hemispherical(const lob_codec* codec);
LOB_API void lob_codec_free(lob_codec* codec);

/* Encodes samples, or all texels of an environment, into lob_codec_size() coefficients. */
LOB_API lob_status lob_encode(const lob_codec* codec, const lob_sample* samples, size_t sample_count,
                              float* coefficients, size_t coefficient_count);
LOB_API lob_status lob_encode_environment(const lob_codec* codec, const lob_environment* environment,
                                          float* coefficients, size_t coefficient_count);
/* Evaluates coefficients at one or many directions; `out` has `count` colours. */
LOB_API lob_status lob_radiance(const lob_codec* codec, const float* coefficients, size_t coefficient_count,
                                const float* directions, size_t count, float* out);
LOB_API lob_status lob_irradiance(const lob_codec* codec, const float* coefficients, size_t coefficient_count,
                                  const float* normals, size_t count, float* out);
/* Computes the exact irradiance of an environment, the reference for the above. */
LOB_API lob_status lob_environment_irradiance(const lob_environment* environment, const float* normals, size_t count,
                                              float* out);

/* Accumulators: encoding of samples as they arrive -------------------------------------------------------------- */

typedef struct lob_accumulator lob_accumulator;

LOB_API lob_status lob_accumulator_create(const lob_codec* codec, lob_accumulator** out);
LOB_API lob_status lob_accumulator_add(lob_accumulator* accumulator, const lob_sample* samples, size_t count);
/* Adds what `other`, of the same codec, has seen. */
LOB_API lob_status lob_accumulator_merge(lob_accumulator* accumulator, const lob_accumulator* other);
LOB_API lob_status lob_accumulator_solve(const lob_accumulator* accumulator, float* coefficients,
                                         size_t coefficient_count);
LOB_API void lob_accumulator_free(lob_accumulator* accumulator);

/* Storages: coefficients of many texels as textures ------------------------------------------------------------- */

typedef struct lob_textures lob_textures;

typedef struct lob_texture {
    const char* name;
    uint32_t vk_format;   /* VkFormat; formats that Vulkan lacks are VK_FORMAT_R8G8B8A8_UNORM */
    size_t width, height; /* texels */
    float scale;          /* factor of stored values, before offset and scale of each channel */
    const void* data;     /* belongs to the lob_textures */
    size_t bytes;
} lob_texture;

/* Packs width * height texels, each of lob_codec_size() coefficients, texel after texel. */
LOB_API lob_status lob_pack(const lob_codec* codec, const char* storage, const float* coefficients, size_t width,
                            size_t height, lob_textures** out);
/* Unpacks into an array of the same shape; `float_count` is 3 * lob_codec_size() * width * height. */
LOB_API lob_status lob_unpack(const lob_textures* textures, float* coefficients, size_t float_count);
LOB_API size_t lob_textures_count(const lob_textures* textures);
LOB_API lob_status lob_textures_get(const lob_textures* textures, size_t index, lob_texture* out);
LOB_API void lob_textures_free(lob_textures* textures);

/* Scenes and bakes -------------------------------------------------------------------------------------------- */

typedef struct lob_scene lob_scene;
typedef struct lob_bake lob_bake;
typedef struct lob_stop lob_stop;

/* Loads a .glb or .gltf file, or an embedded scene such as "cornell". Safe on any bytes. */
LOB_API lob_status lob_scene_load(const char* path, lob_scene** out);
/* Surrounds the scene with a copy of an environment; NULL: with darkness. */
LOB_API lob_status lob_scene_set_environment(lob_scene* scene, const lob_environment* environment);
LOB_API void lob_scene_free(lob_scene* scene);

/* A flag that stops a bake. lob_stop_set may be called from any thread, from a progress callback and from a signal
 * handler. */
LOB_API lob_status lob_stop_create(lob_stop** out);
LOB_API void lob_stop_set(lob_stop* stop);
LOB_API void lob_stop_free(lob_stop* stop);

/* Receives the fraction done, [0, 1], and the stage, "texels" or "probes"; may come from any thread, never
 * concurrently. */
typedef void (*lob_progress)(void* user, double done, const char* stage);
/* Receives each warning. */
typedef void (*lob_warning)(void* user, const char* text);

/* Options of a bake, with the defaults of `lobelia bake`, whose -h describes them. */
typedef struct lob_bake_options {
    size_t struct_size;      /* set by lob_bake_options_init */
    const char* codec;       /* "": irradiance at the shading normal only */
    const char* folder;      /* holds the checkpoint, then the files; NULL: no files */
    size_t width, height;    /* of a page [texels], 1 to 16384 */
    double texels_per_metre; /* 0: from the UVs */
    uint32_t samples;        /* per texel, 1 to 1000000 */
    uint32_t bounces;        /* 0 to 64 */
    uint32_t seed;
    uint32_t threads;     /* 0: one per processor; the result does not depend on it */
    uint64_t memory;      /* budget [bytes] */
    double most_seconds;  /* 0: no limit */
    double target_error;  /* 0: the same number of samples for all texels */
    double probe_spacing; /* [m]; 0: no probes */
    int tangent_frame;    /* 1: spherical coefficients in the tangent frame of each texel; 0: in the world's */
    int denoise, seams, dilate, push_out; /* 1 or 0 */
    int resume;                           /* 1: continue the checkpoint in the folder */
    lob_progress progress;                /* or NULL */
    lob_warning warning;                  /* or NULL */
    void* user;                           /* for both */
    const lob_stop* stop;                 /* or NULL */
} lob_bake_options;

/* Sets the defaults; `struct_size` is sizeof(lob_bake_options). */
LOB_API void lob_bake_options_init(lob_bake_options* options, size_t struct_size);
/* Bakes the scene; `options` may be NULL. LOB_STOPPED if the stop was set: the last checkpoint stays. */
LOB_API lob_status lob_bake_scene(const lob_scene* scene, const lob_bake_options* options, lob_bake** out);
/* Reads the folder of a finished bake. Safe on any bytes. */
LOB_API lob_status lob_bake_read(const char* folder, lob_bake** out);
/* Writes pages, textures and bake.json, and a copy of the scene unless it is NULL. */
LOB_API lob_status lob_bake_write(const lob_bake* bake, const char* folder, const lob_scene* scene);
LOB_API void lob_bake_free(lob_bake* bake);

LOB_API const char* lob_bake_codec(const lob_bake* bake);
LOB_API size_t lob_bake_page_count(const lob_bake* bake);
LOB_API size_t lob_bake_width(const lob_bake* bake);
LOB_API size_t lob_bake_height(const lob_bake* bake);
/* Coefficients per texel, each a colour. */
LOB_API size_t lob_bake_coefficient_count(const lob_bake* bake);
/* A channel of a page as width * height floats, which belong to the bake: "c0.R", "c0.G", "c0.B", "c1.R" and so on,
 * "E.R", "E.G", "E.B" (irradiance at the shading normal), "E.error", "validity". */
LOB_API lob_status lob_bake_channel(const lob_bake* bake, size_t page, const char* channel, const float** out);

#ifdef __cplusplus
}
#endif

#endif
