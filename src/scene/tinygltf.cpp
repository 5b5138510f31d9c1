// tinygltf's implementation, compiled here so that it can neither open files nor decode pictures.
#include <fstream>  // named by its writers, which nobody calls

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
