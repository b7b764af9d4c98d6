"""Prints the reference of the tasks: python3 -m vinerow.gym"""

from . import TASKS, describe


def number(value: float) -> str:
    return f"{value:.6g}"


def page() -> str:
    """docs/reference/gym.md"""
    lines = ["# Tasks of vinerow.gym", "",
             "Written by `python3 -m vinerow.gym`. Bounds are those of the default parameters; [guide](../guides/gym.md)."]
    for task in describe():
        definition = TASKS[task["name"]]
        lines += ["", f"## {task['name']}", "", f"{task['description']}. `{definition.id}`", ""]
        lines += ["| observation | from | to |", "|---|---|---|"]
        lines += [f"| `{name}` | {number(low)} | {number(high)} |" for name, low, high in task["observation"]]
        lines += ["", "Actions, -1 to 1: " + ", ".join(f"`{name}`" for name, _, _ in task["action"]) + ".",
                  "Info: " + ", ".join(f"`{name}`" for name in task["numbers"]) + ", `succeeded`.", "",
                  "| parameter | unit | default | allowed | meaning |", "|---|---|---|---|---|"]
        lines += [f"| `{name}` | {unit} | {number(default)} | {allowed} | {text} |"
                  for name, unit, default, allowed, text in task["parameters"]]
        lines += ["", "| varies | key | values |", "|---|---|---|"]
        for name, factor in definition.factors.items():
            values = ", ".join(str(value).lower() for value in factor["values"]) if "values" in factor else (
                f"{number(factor['from'])} to {number(factor['to'])}, {factor['count']} values")
            lines.append(f"| {name} | `{factor['key']}` | {values} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(page(), end="")
