# luthier_materials(TARGET FOLDER <folder> OUT <folder> [SHARDS <number>] [STORE <folder>] [OPTIONS <option>...])
#
# A target that bakes the material files of a folder into OUT, as so many shares and a merge. Shares are commands of the build, so
# that `cmake --build . -j 8` runs eight at once. STORE keeps results between builds; by default it lies in the build folder.
# LUTHIER names the program, and LUTHIER_LAUNCH a command that goes before it, such as srun;--ntasks=1.
cmake_minimum_required(VERSION 3.21)

find_program(LUTHIER luthier REQUIRED)
set(LUTHIER_LAUNCH "" CACHE STRING "Command before luthier, such as srun;--ntasks=1")

function(luthier_materials target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER;OUT;SHARDS;STORE" "OPTIONS")
  if(NOT arg_SHARDS)
    set(arg_SHARDS 4)
  endif()
  if(NOT arg_STORE)
    set(arg_STORE ${CMAKE_CURRENT_BINARY_DIR}/luthier-store)
  endif()
  get_filename_component(folder ${arg_FOLDER} ABSOLUTE)
  get_filename_component(out ${arg_OUT} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
  # A material or a lock that comes or goes configures the build anew.
  file(GLOB inputs CONFIGURE_DEPENDS ${folder}/*.toml ${folder}/luthier.lock)

  set(shares "")
  foreach(index RANGE 1 ${arg_SHARDS})
    set(share ${CMAKE_CURRENT_BINARY_DIR}/${target}-share-${index})
    add_custom_command(
      OUTPUT ${share}
      COMMAND ${LUTHIER_LAUNCH} ${LUTHIER} bake ${folder} ${arg_OPTIONS} --shard ${index}/${arg_SHARDS} --cache ${arg_STORE}
              --threads 1 --quiet
      COMMAND ${CMAKE_COMMAND} -E touch ${share}
      DEPENDS ${inputs} ${LUTHIER}
      COMMENT "Materials, share ${index} of ${arg_SHARDS}"
      VERBATIM)
    list(APPEND shares ${share})
  endforeach()

  # The depfile names what the package was made of: materials, and the files that these refer to. luthier does not write a manifest
  # that would stay the same, so its date is set here.
  set(depfile ${CMAKE_CURRENT_BINARY_DIR}/${target}.d)
  # CMake's Makefiles never forget a file that a depfile has named: once it is removed, they would merge at every build.
  set(forget "")
  if(CMAKE_GENERATOR MATCHES Makefiles)
    set(forget COMMAND ${CMAKE_COMMAND} -E rm -f ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/compiler_depend.internal)
  endif()
  add_custom_command(
    OUTPUT ${out}/manifest.json
    COMMAND ${LUTHIER_LAUNCH} ${LUTHIER} merge ${folder} ${arg_OPTIONS} --cache ${arg_STORE} --out ${out} --depfile ${depfile} --quiet
    COMMAND ${CMAKE_COMMAND} -E touch ${out}/manifest.json
    ${forget}
    DEPENDS ${inputs} ${shares}
    DEPFILE ${depfile}
    COMMENT "Materials, merge"
    VERBATIM)
  add_custom_target(${target} DEPENDS ${out}/manifest.json)
endfunction()
