// A Flamenco 3 job type: converts every take of a shoot, one task a take, then gathers the motions in an asset library.
// docs/farm_flamenco.md explains how to install and submit it. For Flamenco 3.5 or newer.

const AS_TAKES_SAY = "as the takes say";

const JOB_TYPE = {
    label: "Keymark: Convert a Shoot",
    description: "Turn the clips of a shoot into animated armatures, and gather their motions in an asset library",
    settings: [
        {
            key: "shoot",
            type: "string",
            subtype: "dir_path",
            required: true,
            visible: "submission",
            label: "Shoot",
            description: "Folder of the takes, with shoot.json. All workers must reach it",
        },
        {
            key: "output",
            type: "string",
            subtype: "dir_path",
            required: true,
            visible: "submission",
            label: "Results",
            description: "Folder for all results, new or old, that all workers reach",
        },
        {
            key: "tasks",
            type: "int32",
            default: 0,
            propargs: { min: 0, max: 100000 },
            label: "Tasks",
            description:
                "Number of tasks that share the takes: as many as takes gives each its own. Fewer share them evenly; " +
                "surplus tasks end at once",
            eval:
                "len([file for file in Path(abspath(settings.shoot)).rglob('*') if file.name == 'take.json' or " +
                "(file.suffix.lower() in {'.avi', '.m4v', '.mkv', '.mov', '.mp4', '.mpeg', '.mpg', '.mts', '.mxf', " +
                "'.webm', '.wmv'} and not (file.parent / 'take.json').exists())]) if settings.shoot else 0",
            evalInfo: {
                showLinkButton: true,
                description: "One for each take in the folder",
            },
        },
        {
            key: "method",
            type: "string",
            choices: ["map", "ekf", "interpolation"],
            default: "map",
            label: "Method",
            description:
                "Method of takes for which no file of the shoot names one. map: the whole clip at once. ekf: the " +
                "paper's filter. interpolation: the keyframes alone",
        },
        {
            key: "keyframes",
            type: "string",
            choices: [AS_TAKES_SAY, "auto"],
            default: AS_TAKES_SAY,
            label: "Keyframes",
            description:
                "Keyframes of takes for which no file of the shoot says how they are found. auto finds them in the " +
                "footage with all of the workers' libraries",
        },
        {
            key: "library",
            type: "string",
            choices: [
                AS_TAKES_SAY,
                "aerobic",
                "balance",
                "jumping",
                "kicking",
                "punching",
                "reaching",
                "running",
                "squatting_lifting",
                "turning",
                "walking",
                "waving",
            ],
            default: AS_TAKES_SAY,
            label: "Keyframe Library",
            description:
                "Library to match takes with, in place of finding keyframes with all of them, for which no file of " +
                "the shoot names one",
        },
        {
            key: "own_library",
            type: "string",
            subtype: "file_path",
            default: "",
            visible: "submission",
            label: "Own Library",
            description: "File of a keyframe library to match takes with, in place of the one above",
        },
        {
            key: "keypoints",
            type: "string",
            default: "",
            label: "Keypoint File",
            description:
                "Name that the file of keypoints has in every take for which no file of the shoot names one. Empty: " +
                "keypoints.json where it is there",
        },
        {
            key: "evidence",
            type: "string",
            default: "",
            label: "Evidence",
            description:
                "What motions are held against where no file of the shoot says it: one or more of markers, keypoints, " +
                "depth_hints, contours, with commas between. Empty: whatever a take has",
        },
        {
            key: "merge",
            type: "bool",
            default: true,
            label: "Asset Library",
            description: "Gather all motions in one .blend with catalogs, in asset_library among the results",
        },
        {
            key: "name",
            type: "string",
            subtype: "file_name",
            default: "",
            label: "Name",
            description: "Name of the shoot in the asset library's file and catalogs",
            eval: "jobname",
            evalInfo: {
                showLinkButton: true,
                description: "The job's name",
            },
        },
        {
            key: "go_on",
            type: "bool",
            default: true,
            label: "Go On after Failed Takes",
            description:
                "Let the tasks of takes that cannot be converted succeed and merge the others; then the last task " +
                "fails and names them. Otherwise their tasks fail, and a worker with three failures gets no more",
        },
        {
            key: "program",
            type: "string",
            default: "{blender}",
            required: true,
            visible: "submission",
            label: "Blender or Keymark",
            description: "Command by which workers call a Blender that has Keymark, or the command keymark itself",
        },

        // Absolute paths for the workers: in Blender paths may be relative to the .blend.
        {
            key: "shoot_path",
            type: "string",
            subtype: "dir_path",
            visible: "web",
            eval: "str(abspath(settings.shoot)) if settings.shoot else ''",
            description: "Folder of the takes",
        },
        {
            key: "output_path",
            type: "string",
            subtype: "dir_path",
            visible: "web",
            eval: "str(abspath(settings.output)) if settings.output else ''",
            description: "Folder of the results",
        },
        {
            key: "own_library_path",
            type: "string",
            subtype: "file_path",
            visible: "web",
            eval: "str(abspath(settings.own_library)) if settings.own_library else ''",
            description: "File of the keyframe library",
        },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const shoot = folderOf(settings, "shoot", "the folder of the takes");
    const output = folderOf(settings, "output", "the folder for the results");
    const count = settings.tasks;
    if (!Number.isInteger(count) || count < 1) {
        throw `Tasks is ${count}; it must be 1 or more, and best as many as there are takes in ${shoot}`;
    }
    const tasks = [];
    for (let part = 1; part <= count; part++) {
        tasks.push(convertTask(settings, shoot, output, part, count));
    }
    for (const task of tasks) {
        job.addTask(task);
    }
    if (isOn(settings.merge)) {
        const merge = mergeTask(settings, output, nameOf(job));
        for (const task of tasks) {
            merge.addDependency(task);
        }
        job.addTask(merge);
    }
}

// Without Blender's add-on, as over the API, paths are not made absolute; they must be absolute already.
function folderOf(settings, key, what) {
    const folder = settings[`${key}_path`] || settings[key];
    if (!folder || folder.startsWith("//")) {
        throw `${key} is '${folder || ""}'; it must be ${what}, as an absolute path that all workers reach`;
    }
    return folder;
}

function isOn(setting) {
    return setting === undefined || setting === null || setting === true;
}

// A valid file name on every system.
function nameOf(job) {
    const name = (job.settings.name || job.name || "").replace(/[\\/:*?"<>|]/g, "-").trim();
    return name || "shoot";
}

function convertTask(settings, shoot, output, part, count) {
    const digits = `${count}`.length;
    const words = ["batch", shoot, "--output", output, "--part", `${part}/${count}`, "--jobs", "1"];
    words.push("--failed-takes", isOn(settings.go_on) ? "pass" : "fail");
    if (settings.method) {
        words.push("--method", settings.method);
    }
    const own = settings.own_library_path || settings.own_library;
    const library = own || (settings.library !== AS_TAKES_SAY && settings.library);
    const found = settings.keyframes && settings.keyframes !== AS_TAKES_SAY;
    if (found && library) {
        throw `Keyframes is ${settings.keyframes} and the library is ${library}; it must be one of them`;
    }
    if (found) {
        words.push("--keyframes", settings.keyframes);
    }
    if (library) {
        words.push("--library", library);
    }
    for (const option of ["keypoints", "evidence"]) {
        if (settings[option]) {
            words.push(`--${option}`, settings[option]);
        }
    }
    return keymarkTask(`convert-${`${part}`.padStart(digits, "0")}`, settings, words);
}

function mergeTask(settings, output, name) {
    const file = path.join(output, "asset_library", `${name}.blend`);
    return keymarkTask("merge", settings, ["merge", output, "--output", file, "--name", name]);
}

// Not `blender-render`: its arguments for rendering, as in {blenderArgs}, may switch extensions off.
function keymarkTask(name, settings, words) {
    const task = author.Task(name, "blender");
    task.addCommand(
        author.Command("exec", {
            exe: settings.program || "{blender}",
            // Blender needs these words before an extension's command; keymark ignores them.
            args: ["--command", "keymark", ...words],
        }),
    );
    return task;
}
