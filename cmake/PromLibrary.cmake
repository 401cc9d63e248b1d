# prom_flags(target): the language settings and warnings that every target of the project has.
function(prom_flags target)
    target_compile_definitions(${target} PRIVATE _GNU_SOURCE CGLM_ALL_UNALIGNED
                               PROM_VERSION="${PROJECT_VERSION}")
    target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow
        $<$<COMPILE_LANGUAGE:C>:-Wconversion -Wno-sign-conversion -Wstrict-prototypes>
        $<$<BOOL:${PROM_WERROR}>:-Werror>)
    target_link_libraries(${target} PRIVATE m)
    if(PROM_SANITIZE)
        target_compile_options(${target} PUBLIC -fsanitize=address,undefined
                               -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
        target_link_options(${target} PUBLIC -fsanitize=address,undefined)
        target_compile_definitions(${target} PUBLIC PROM_SANITIZE)
    endif()
endfunction()

# prom_library(name LINK public... PRIVATE private...): the folder's sources as one static library;
# folders in it with a CMakeLists.txt are libraries of their own.
function(prom_library name)
    cmake_parse_arguments(ARG "" "" "LINK;PRIVATE" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "*.c" "*.cpp" "*.h")
    file(GLOB_RECURSE nested RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} "*/CMakeLists.txt")
    foreach(list_file ${nested})
        get_filename_component(folder ${list_file} DIRECTORY)
        if(folder)
            list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${folder}/")
        endif()
    endforeach()
    add_library(${name} STATIC ${sources})
    set_target_properties(${name} PROPERTIES LINKER_LANGUAGE C)
    prom_flags(${name})
    target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE})
endfunction()
