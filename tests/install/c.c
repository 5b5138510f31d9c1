/* A project in C. */
#include <lobelia/lobelia_c.h>
#include <stdio.h>

int main(void) {
    lob_environment* sky = NULL;
    lob_codec* codec = NULL;
    float c[27];
    if (lob_environment_sky(64, 32, 3, 40, 45, &sky) || lob_codec_create("sh2/least-squares/convolution", &codec) ||
        lob_encode_environment(codec, sky, c, 9)) {
        fprintf(stderr, "%s\n", lob_error());
        return 1;
    }
    printf("%s: %lu coefficients, mean %g\n", lob_codec_name(codec), (unsigned long)lob_codec_size(codec),
           0.282095 * c[1]);
    lob_codec_free(codec);
    lob_environment_free(sky);
    return 0;
}
