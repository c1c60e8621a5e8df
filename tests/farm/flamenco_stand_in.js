// Stands in for Flamenco Manager: runs a job compiler script as it does, and refuses what it, its add-on or its workers
// would not understand. Interface: the schemas AvailableJobType and AvailableJobSetting of the Manager's API, the names
// that its job compilers offer, and the commands of Flamenco Worker, as documented for Flamenco 3.5.
//
// node flamenco_stand_in.js SCRIPT < {"name": ..., "settings": {...}}   writes {"jobType": ..., "tasks": [...]}
"use strict";

const fs = require("fs");
const vm = require("vm");

const TYPES = { string: "string", int32: "number", float: "number", bool: "boolean" };
const SUBTYPES = ["file_path", "dir_path", "file_name", "hashed_file_path"];
const VISIBILITIES = ["visible", "hidden", "submission", "web"];
const TASK_TYPES = ["blender", "ffmpeg", "file-management", "misc"];
const SETTING = {
    key: "string",
    type: "string",
    subtype: "string",
    choices: "array",
    propargs: "object",
    description: "string",
    label: "string",
    default: "any",
    eval: "string",
    evalInfo: "object",
    visible: "string",
    required: "boolean",
    editable: "boolean",
};
// Of each command its parameters; those with a star must be there.
const COMMANDS = {
    "blender-render": { "exe*": "string", exeArgs: "string", argsBefore: "strings", blendfile: "string", args: "strings" },
    "frames-to-video": {
        "exe*": "string",
        exeArgs: "string",
        "fps*": "number",
        "inputGlob*": "string",
        "outputFile*": "string",
        argsBefore: "strings",
        args: "strings",
    },
    "make-directory": { "path*": "string" },
    "move-directory": { "src*": "string", "dest*": "string" },
    "copy-file": { "src*": "string", "dest*": "string" },
    exec: { "exe*": "string", args: "strings" },
    echo: { "message*": "string" },
    sleep: { "duration_in_seconds*": "number" },
};

class Refused extends Error {}

function refuse(sentence) {
    throw new Refused(sentence);
}

function is(kind, value) {
    switch (kind) {
        case "any":
            return value !== undefined;
        case "array":
            return Array.isArray(value);
        case "strings":
            return Array.isArray(value) && value.every((item) => typeof item === "string");
        case "object":
            return typeof value === "object" && value !== null && !Array.isArray(value);
        default:
            return typeof value === kind;
    }
}

function checkKnown(what, given, known) {
    for (const [name, value] of Object.entries(given)) {
        const kind = known[name] || known[`${name}*`] || refuse(`${what} has no ${name}`);
        is(kind, value) || refuse(`${name} of ${what} is ${JSON.stringify(value)}; it must be: ${kind}`);
    }
    for (const name of Object.keys(known)) {
        const plain = name.slice(0, -1);
        if (name.endsWith("*") && (given[plain] === undefined || given[plain] === "")) {
            refuse(`${what} lacks ${plain}`);
        }
    }
}

function checkJobType(jobType) {
    checkKnown("JOB_TYPE", jobType, { "label*": "string", description: "string", "settings*": "array" });
    const keys = jobType.settings.map((setting) => setting.key);
    new Set(keys).size === keys.length || refuse("two settings have the same key");
    jobType.settings.forEach(checkSetting);
}

function checkSetting(setting) {
    const what = `setting ${setting.key}`;
    checkKnown(what, setting, { ...SETTING, "key*": "string", "type*": "string" });
    /^[a-z][a-z0-9_]*$/.test(setting.key) || refuse(`${what} is no name of a property`);
    const native = TYPES[setting.type] || refuse(`${what} is of an unknown type ${setting.type}`);
    if (setting.subtype !== undefined) {
        SUBTYPES.includes(setting.subtype) || refuse(`${what} is of an unknown subtype ${setting.subtype}`);
        setting.type === "string" || refuse(`${what} has a subtype, which only texts have`);
    }
    if (setting.visible !== undefined && !VISIBILITIES.includes(setting.visible)) {
        refuse(`${what} is visible to ${setting.visible}`);
    }
    if (setting.default !== undefined) {
        typeof setting.default === native || refuse(`the default of ${what} is no ${setting.type}`);
        setting.type !== "int32" || Number.isInteger(setting.default) || refuse(`the default of ${what} is not whole`);
    }
    if (setting.choices !== undefined) {
        setting.type === "string" || refuse(`${what} has choices, which only texts have`);
        is("strings", setting.choices) || refuse(`a choice of ${what} is no text`);
        setting.choices.includes(setting.default) || refuse(`the default of ${what} is none of its choices`);
    }
    if (setting.evalInfo !== undefined) {
        checkKnown(`evalInfo of ${what}`, setting.evalInfo, { showLinkButton: "boolean", "description*": "string" });
        is("boolean", setting.evalInfo.showLinkButton) || refuse(`evalInfo of ${what} lacks showLinkButton`);
        setting.eval || refuse(`${what} has evalInfo and no eval`);
    }
}

function checkSubmitted(jobType, settings) {
    for (const setting of jobType.settings) {
        const value = settings[setting.key];
        if (value === undefined) {
            setting.required && refuse(`the job lacks the setting ${setting.key}`);
        } else if (typeof value !== TYPES[setting.type]) {
            refuse(`the job's ${setting.key} is no ${setting.type}`);
        }
    }
    for (const key of Object.keys(settings)) {
        jobType.settings.some((setting) => setting.key === key) || refuse(`the job has a setting ${key} of no use`);
    }
}

class Command {
    constructor(name, parameters) {
        const known = COMMANDS[name] || refuse(`no worker knows the command ${name}`);
        checkKnown(`command ${name}`, parameters, known);
        Object.assign(this, { name, parameters });
    }
}

class Task {
    constructor(name, type) {
        const texts = [name, type].every((text) => typeof text === "string" && text.trim() !== "");
        texts || refuse("author.Task needs a name and a type");
        TASK_TYPES.includes(type) || refuse(`no worker is set up for tasks of type ${type}`);
        Object.assign(this, { name, type, commands: [], dependencies: [] });
    }

    addCommand(command) {
        command instanceof Command || refuse(`task ${this.name} is given a command that author did not make`);
        this.commands.push(command);
    }

    addDependency(task) {
        task instanceof Task || refuse(`task ${this.name} depends on something that is no task`);
        task !== this || refuse(`task ${this.name} depends on itself`);
        this.dependencies.push(task);
    }
}

class Job {
    constructor(name, settings) {
        Object.assign(this, { name, settings, tasks: [], created: new Date(0), priority: 50 });
    }

    addTask(task) {
        task instanceof Task || refuse("the job is given something that is no task");
        this.tasks.includes(task) && refuse(`task ${task.name} is added twice`);
        task.commands.length > 0 || refuse(`task ${task.name} has no command`);
        this.tasks.push(task);
    }
}

// Like the Manager's, for both kinds of slash: a path goes on with the kind it begins with.
const path = {
    join: (...parts) => {
        const slash = parts[0].includes("\\") && !parts[0].includes("/") ? "\\" : "/";
        return parts.map((part, index) => (index ? part : part.replace(/[\\/]+$/, ""))).join(slash);
    },
    basename: (whole) => whole.split(/[\\/]/).pop(),
    dirname: (whole) => whole.split(/[\\/]/).slice(0, -1).join("/") || ".",
    stem: (whole) => path.basename(whole).replace(/\.[^.]*$/, ""),
};

function main() {
    const source = fs.readFileSync(process.argv[2], "utf8");
    const given = JSON.parse(fs.readFileSync(0, "utf8"));
    const author = {
        Task: (name, type) => new Task(name, type),
        Command: (name, parameters) => new Command(name, parameters),
    };
    const names = {
        author,
        path,
        process: { platform: "linux", cwd: () => "/" },
        print: () => undefined,
        alert: () => undefined,
        frameChunker: () => [],
        frameCount: () => 0,
        formatTimestampLocal: () => "1970-01-01_000000",
        shellSplit: (text) => text.split(/\s+/),
    };
    // Strict, as the Manager compiles scripts; what they declare is no property of the context, so it is asked for.
    const script = `"use strict";\n${source}\n;({ JOB_TYPE, compileJob });`;
    const { JOB_TYPE, compileJob } = vm.runInNewContext(script, names, { filename: process.argv[2], timeout: 5000 });
    const jobType = JSON.parse(JSON.stringify(JOB_TYPE));
    checkJobType(jobType);
    const job = new Job(given.name, given.settings);
    checkSubmitted(jobType, given.settings);
    compileJob(job);
    for (const task of job.tasks) {
        for (const other of task.dependencies) {
            job.tasks.includes(other) || refuse(`task ${task.name} waits for ${other.name}, which is not of the job`);
        }
    }
    const tasks = job.tasks.map((task) => ({
        ...task,
        dependencies: task.dependencies.map((other) => other.name),
    }));
    process.stdout.write(JSON.stringify({ jobType, tasks }));
}

try {
    main();
} catch (error) {
    // Scripts throw sentences.
    process.stderr.write(typeof error === "string" ? error : error instanceof Refused ? `refused: ${error.message}` : `${error.stack}`);
    process.exitCode = 1;
}
