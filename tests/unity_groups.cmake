# SPDX-License-Identifier: GPL-3.0-or-later
# Most of what a test costs to compile is in headers that its neighbours include too, so files of a
# folder are compiled together, unless both give something the same name: the compiler would refuse
# it or, which is worse, take the other file's function for a call that suits both.

# Law: as many as compile within seconds, as whoever changes one of them waits for all.
set(FILES_AT_ONCE 9)

# names_in(FILE DEFINED USED): what a file defines outside of classes, and what it takes from other
# namespaces by name.
function(names_in file defined_in used_in)
    file(READ ${file} text)
    string(REGEX MATCHALL "\n[A-Za-z][A-Za-z0-9_:<>,&* ]*[ &*>][a-z][a-z0-9_]*\\(" functions "${text}")
    string(REGEX MATCHALL "\nconst[A-Za-z0-9_:<>,&* ]* k[A-Z][A-Za-z0-9_]*" constants "${text}")
    string(REGEX MATCHALL "\n(struct|class|enum|enum class|using) [A-Z][A-Za-z0-9_]*" types "${text}")
    string(REGEX MATCHALL "\nusing [a-z_:]+::[A-Za-z0-9_]+" used "${text}")
    set(defined ${functions} ${constants} ${types})
    list(TRANSFORM defined REPLACE "^.*[ &*>]([A-Za-z0-9_]+)\\(?$" "\\1")
    list(TRANSFORM used REPLACE "^.*::" "")
    set(${defined_in} ${defined} PARENT_SCOPE)
    set(${used_in} ${used} PARENT_SCOPE)
endfunction()

# shares_one(RESULT FIRST SECOND): whether lists of these names have a name in common.
function(shares_one result first second)
    set(found FALSE)
    foreach(name ${${first}})
        if(name IN_LIST ${second})
            set(found TRUE)
            break()
        endif()
    endforeach()
    set(${result} ${found} PARENT_SCOPE)
endfunction()

# compile_folders_together(TARGET FILE...)
function(compile_folders_together target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    # A class of an unnamed namespace that others derive from: GCC sees no file around them.
    target_compile_options(${target} PRIVATE
        $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
    # A name that is new may part two files.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
    foreach(file ${ARGN})
        names_in(${file} defined used)
        get_filename_component(folder ${file} DIRECTORY)
        file(RELATIVE_PATH folder ${CMAKE_CURRENT_SOURCE_DIR} ${folder})
        string(MAKE_C_IDENTIFIER ${folder} folder)
        set(part 0)
        while(TRUE)
            set(group ${folder}_${part})
            list(LENGTH files_${group} files)
            shares_one(both_define defined defined_${group})
            shares_one(defines_used defined used_${group})
            shares_one(uses_defined used defined_${group})
            if(files LESS FILES_AT_ONCE AND NOT both_define AND NOT defines_used AND NOT uses_defined)
                break()
            endif()
            math(EXPR part "${part} + 1")
        endwhile()
        list(APPEND files_${group} ${file})
        list(APPEND defined_${group} ${defined})
        list(APPEND used_${group} ${used})
        set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${group})
    endforeach()
endfunction()
