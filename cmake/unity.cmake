# CMAKE_UNITY_BUILD: compiles the sources of a target together, some at a time. A build from nothing takes a third of the
# time; a change takes longer. No two sources of a target define the same name in unnamed namespaces.

# lobelia_kernels_alone(<target>): leaves out sources that include themselves for each instruction set.
function(lobelia_kernels_alone target)
  get_target_property(sources ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder})
    file(STRINGS ${source} kernels REGEX "hwy/foreach_target.h" LIMIT_COUNT 1)
    if(kernels)
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endfunction()
