/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OpenFOAM's polyMesh, as polyhedra or elements. */
#include "target.h"

#include "../../../lib/format/openfoam/openfoam.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_openfoam_file file[TM_OPENFOAM_FILES] = {0};
    bytes_start(bytes, size);
    for (int i = 0; i < TM_OPENFOAM_FILES && (size > 0 || i < TM_FOAM_CELL_ZONES); i++) {
        file[i].path = tm_openfoam_name[i];
        file[i].bytes = next_file(&bytes, &size);
    }
    for (int elements = 0; elements < 2; elements++) {
        tm_stream stream;
        tm_openfoam_report report;
        tm_error error = {.status = TM_OK};
        tm_stream_init(&stream);
        const tm_status status =
            tm_openfoam_read(&stream, file, elements, &report, &error);
        check_read(&stream, status, &error);
        tm_openfoam_report_free(&report);
    }
    return 0;
}
